"""Bridges read from tables against the analytic ones that were written into them; and what no table may hold."""

import pickle
from pathlib import Path

import control as ct
import numpy as np
import pytest
from scipy.integrate import quad

import hsictrl as hsi
from hsictrl.cli.description import read_description

EXAMPLE = Path(__file__).parent.parent / "examples" / "finite_elements.toml"
X = np.linspace(0.0, 50.0, 51)
DECK = {"width": 3.0, "mass": 50e3}
# Between nodes, where nothing but the interpolation answers.
BETWEEN = [7.3, 18.5, 24.5, 42.9]


def beam(n_modes=3):
    return hsi.Footbridge.simply_supported(
        length=50.0, frequency=2.0, damping=[0.005, 0.01, 0.02][:n_modes], n_modes=n_modes, **DECK)


def csv(folder, name, columns):
    """Write columns as a table; numbers with every digit."""
    path = folder / name
    rows = [",".join(map(str, row)) for row in zip(*columns.values(), strict=True)]
    path.write_text("\n".join([",".join(columns), *rows]) + "\n", encoding="utf-8")
    return path


def export(folder, *, n_modes=3, scales=None, modal_mass=None, order=slice(None), x=X):
    """What a finite-element package would write about the beam: mass-normalised unless scaled otherwise."""
    bridge = beam(n_modes)
    scales = np.full(n_modes, 1 / np.sqrt(25e3)) if scales is None else scales
    shapes = {f"vertical_{j}": (scales[j - 1] * np.sin(j * np.pi * x / 50))[order] for j in range(1, n_modes + 1)}
    masses = {} if modal_mass is None else {"modal_mass": modal_mass}
    return (csv(folder, "nodes.csv", {"x": x[order], **shapes}),
            csv(folder, "modes.csv", {"mode": range(1, n_modes + 1), "frequency": [m.frequency for m in bridge.modes],
                                      "damping": bridge.damping, **masses}))


def read(paths):
    return hsi.Footbridge.from_csv(paths[0], modes=paths[1], **DECK)


# --- a beam there and back ------------------------------------------------------------------------


def same_response(bridge, analytic):
    """Accelerances between all pairs of points, off the nodes, over all three peaks: 1e-6 of the largest there."""
    omega = 2 * np.pi * np.concatenate([np.linspace(0.5, 20, 300), [2.0, 8.0, 18.0]])
    found, expected = (ct.frequency_response(one.ss(at=BETWEEN), omega).frdata for one in (bridge, analytic))
    largest = np.max(np.abs(expected), axis=(0, 1))
    assert np.max(np.abs(found - expected) / largest) < 1e-6


def test_a_beam_with_51_nodes_comes_back(tmp_path):
    same_response(read(export(tmp_path)), beam())


def test_so_does_one_with_modal_masses_that_belong_to_other_scales(tmp_path):
    """φ'Mφ grows as the square of φ: 25 t at one is 4 · 25 t at two, and 0.04 · 25 t at 0.2."""
    scales = np.array([2.0, -0.2, 1.0])
    bridge = read(export(tmp_path, scales=scales, modal_mass=25e3 * scales**2))
    assert [mode.modal_mass for mode in bridge.modes] == pytest.approx([25e3] * 3, rel=1e-6)
    same_response(bridge, beam())


def test_a_crowd_finds_the_same_bridge(tmp_path):
    bodies, places = hsi.Pedestrian(), np.linspace(1, 49, 37)
    found, expected = (hsi.effective(hsi.couple(bridge, bodies, places)) for bridge in (read(export(tmp_path)), beam()))
    assert (found.frequency, found.damping) == pytest.approx((expected.frequency, expected.damping), rel=1e-6)


def test_derivatives_are_those_of_the_sine(tmp_path):
    x = np.linspace(0, 50, 997)
    for found, mode in zip(read(export(tmp_path)).modes, beam().modes, strict=True):
        for order, within in ((0, 1e-6), (1, 2e-5), (2, 5e-4)):     # of β^order, three half waves over 51 nodes
            exact = mode.shape.derivative(x, order=order)
            error = np.abs(found.shape.derivative(x, order=order) - exact)
            assert np.max(error) < within * mode.shape.wavenumber**order


def test_convective_terms_follow_the_analytic_bridge(tmp_path):
    walker = hsi.Walker(body=hsi.Pedestrian(), force=hsi.HarmonicForce([0.4]), weight=700.0, step_frequency=2.0,
                        speed=1.25, arrival=0.0)
    found, expected = (hsi.simulate(hsi.moving_crowd(bridge, hsi.Traffic([walker]), convective=True),
                                    np.linspace(0, 10, 501)).response.outputs
                       for bridge in (read(export(tmp_path, n_modes=1)), beam(1)))
    assert np.max(np.abs(found - expected)) < 1e-6 * np.max(np.abs(expected))


@pytest.mark.parametrize("order", [slice(None, None, -1), np.random.default_rng(1).permutation(51)])
def test_nodes_out_of_order_are_sorted_and_told(tmp_path, order):
    bridge = read(export(tmp_path, order=order))
    same_response(bridge, beam())
    assert "nodes were out of order along the deck and have been sorted by x" in bridge.remarks


def test_what_was_inferred_is_told(tmp_path):
    bridge = read(export(tmp_path, n_modes=1))
    assert bridge.remarks == (
        "51 nodes along the deck on 1 line(s); x is counted from 0 m, where they begin",
        "modes.csv, mode 1: 0.00632456 at its antinode (25, 0) m, taken as mass-normalised (1/√kg); scaled to one: "
        "25000 kg, 50 % of the bridge's mass")
    given = read(export(tmp_path, n_modes=1, scales=[2.0], modal_mass=[100e3]))
    assert "mode 1: 2 at its antinode (25, 0) m, with 100000 kg; scaled to one: 25000 kg" in given.remarks[1]
    assert hsi.reference_bridge().remarks == ()


def test_x_counts_from_the_first_node(tmp_path):
    nodes, modes = export(tmp_path)
    columns = np.genfromtxt(nodes, delimiter=",", names=True)
    csv(tmp_path, "nodes.csv", {name: columns[name] + (12.5 if name == "x" else 0) for name in columns.dtype.names})
    bridge = read((nodes, modes))
    same_response(bridge, beam())
    assert "x is counted from 12.5 m" in bridge.remarks[0]


# --- across the deck ------------------------------------------------------------------------------


def across(folder, lines, vertical, lateral, modal_mass=9e3):
    """One mode on a grid, its components functions of x and y."""
    x, y = (grid.ravel() for grid in np.meshgrid(X, lines))
    return (csv(folder, "nodes.csv", {"x": x, "y": y, "vertical_4": vertical(x, y), "lateral_4": lateral(x, y)}),
            csv(folder, "modes.csv", {"mode": [4], "frequency": [3.0], "damping": [0.01], "modal_mass": [modal_mass]}))


def torsion(x, y):
    """Twist about the centre line, one at the edges of the deck, y = ±1.5 m."""
    return np.sin(np.pi * x / 50) * y / 1.5


@pytest.mark.parametrize("lines", [[-1.5, 1.5], [-1.2, 0.0, 1.2], [-2.0, -0.5, 2.0]])
def test_torsion_and_sway_at_any_place(tmp_path, lines):
    """Lines within the edges, at them, or beyond: a section that stays straight is met exactly."""
    bridge = read(across(tmp_path, lines, torsion, lambda x, y: 0.2 * np.sin(np.pi * x / 50)))
    x, y = np.array([[5.5, 25.0, 25.0, 33.3], [0.7, 1.5, 0.0, -1.5]])
    rows = bridge.participation(np.column_stack([x, y]))[:, 0]
    np.testing.assert_allclose(np.abs(rows), np.abs(torsion(x, y)) / np.sqrt(9e3), atol=1e-9)
    swaying = bridge.participation(np.column_stack([x, y]), "lateral")[:, 0]
    sign = np.sign(rows[1])    # of a mode as a whole is free
    np.testing.assert_allclose(sign * swaying, 0.2 * np.sin(np.pi * x / 50) / np.sqrt(9e3), atol=1e-9)
    assert bridge.modes[0].shape.antinode == pytest.approx((25.0, -1.5), abs=1e-6)


def test_modal_mass_belongs_to_the_edge_that_a_walker_reaches(tmp_path):
    """Twice as wide a model: at y = ±3 m it is scaled to one, at the edge of the walkway to a half."""
    nodes, modes = across(tmp_path, [-3.0, 3.0], lambda x, y: torsion(x, y) / 2, lambda x, y: 0 * x)
    assert read((nodes, modes)).modes[0].modal_mass == pytest.approx(4 * 9e3, rel=1e-6)


def test_what_a_solver_leaves_of_nothing_is_no_motion(tmp_path):
    paths = across(tmp_path, [-1.5, 1.5], lambda x, y: 1e-12 * np.cos(x), lambda x, y: np.sin(np.pi * x / 50))
    assert not read(paths).moves_vertically(0)


# --- the shape by itself --------------------------------------------------------------------------


def test_means_along_the_centre_line_by_quadrature():
    """Two half waves and a sway: vertical² + lateral², and the root of it, by scipy.integrate.quad."""
    x = np.linspace(0, 40, 81)
    shape = hsi.SampledShape(x=x, y=[-2.0, 2.0], vertical=np.sin(np.pi * x / 20), lateral=0.3 * np.sin(np.pi * x / 40))

    def square(at):
        return np.sin(np.pi * at / 20) ** 2 + 0.09 * np.sin(np.pi * at / 40) ** 2

    assert shape.mean_square == pytest.approx(quad(square, 0, 40)[0] / 40, rel=1e-7)
    absolute = quad(lambda at: np.sqrt(square(at)), 0, 40, points=[20], limit=200)[0] / 40
    assert shape.mean_absolute == pytest.approx(absolute, rel=1e-6)
    assert hsi.SampledShape(x=x, lateral=np.sin(np.pi * x / 20)).mean_absolute == pytest.approx(2 / np.pi, rel=1e-7)


def test_antinode_between_nodes_is_found():
    """sin(πx/L) on nodes that leave out midspan."""
    x = np.linspace(0, 50, 50)
    shape = hsi.SampledShape(x=x, vertical=-4 * np.sin(np.pi * x / 50))
    assert shape.antinode == pytest.approx((25.0, 0.0), abs=1e-4)
    assert shape.scale == pytest.approx(-4.0, rel=1e-8)
    assert float(shape(25.0)) == pytest.approx(1.0, abs=1e-8)


def test_off_the_deck_it_is_zero_and_it_travels():
    shape = hsi.SampledShape(x=X, y=[-1.5, 1.5], vertical=np.sin(np.pi * X / 50))
    copy = pickle.loads(pickle.dumps(shape))
    np.testing.assert_array_equal(copy([-0.1, 50.1, 25.0, 25.0], [0.0, 0.0, 1.6, 1.5]), [0, 0, 0, copy(25.0)])
    with pytest.raises(ValueError, match="read-only"):
        shape.vertical[0] = 1.0


# --- the command ----------------------------------------------------------------------------------


def test_the_example_is_the_two_span_beam_it_was_exported_from():
    """30 m and 24 m: Footbridge.beam's modes, written with six digits at 55 nodes on two lines."""
    bridge = read_description(EXAMPLE).bridge
    beam = hsi.Footbridge.beam(spans=[30.0, 24.0], ends=("pinned", "clamped"), width=3.0, mass=81e3, frequency=2.4,
                               damping=0.006, n_modes=2)
    assert [mode.frequency for mode in bridge.modes[:2]] == pytest.approx([m.frequency for m in beam.modes], rel=1e-5)
    x = np.linspace(0, 54, 301)
    np.testing.assert_allclose(np.abs(bridge.participation(x)[:, :2]), np.abs(beam.participation(x)),
                               atol=3e-5 * np.max(beam.participation(x)))
    np.testing.assert_allclose(bridge.participation(x)[:, 2], 0, atol=1e-18)     # torsion rests on the centre line
    assert [mode.shape.antinode[1] for mode in bridge.modes] == [0.0, 0.0, -1.5]    # that of bending is on it


def test_a_description_finds_its_tables_and_names_their_cells(tmp_path):
    nodes, modes = export(tmp_path, n_modes=1)
    path = tmp_path / "bridge.toml"
    path.write_text('[bridge]\nkind = "csv"\nshapes = "nodes.csv"\nmodes = "modes.csv"\nwidth = 3.0\nmass = 50e3\n')
    assert str(read_description(path).bridge) == str(read((nodes, modes)))
    modes.write_text("mode,frequency,damping\n1,2.0,0.5\n")
    with pytest.raises(ValueError, match=r"bridge.toml, line 4, \[bridge\] modes: .*modes.csv, row 2, column damping"):
        read_description(path)
    path.write_text('[bridge]\nkind = "csv"\nshapes = 3\nmodes = "modes.csv"\nwidth = 3.0\nmass = 50e3\n')
    with pytest.raises(ValueError, match=r'line 3, \[bridge\] shapes: shapes must be a path in quotes, got 3; write'):
        read_description(path)


# --- refusals -------------------------------------------------------------------------------------

NODES = ["x,vertical_1,vertical_2", *(f"{x},{np.sin(np.pi * x / 50)},{np.sin(np.pi * x / 25)}" for x in range(51))]
MODES = ["mode,frequency,damping,modal_mass", "1,2.0,0.005,25e3", "2,8.0,0.005,25e3"]


def changed(lines, **rows):
    """The table with other rows; r3 is the third of the file, whose first holds the heads."""
    return [rows.get(f"r{i}", line) for i, line in enumerate(lines, start=1)]


def column(lines, index, of):
    """The table with another column."""
    split = [line.split(",") for line in lines]
    return [",".join(of(cell) if i == index and row else cell for i, cell in enumerate(cells))
            for row, cells in enumerate(split)]


@pytest.mark.parametrize(("nodes", "modes", "message"), [
    (column(NODES, 0, lambda x: str(1000 * float(x))), MODES,
     r"nodes.csv, row 52, column x: the length of the deck must lie in \[5, 1000\], got 50000; give metres"),
    (["x,y,vertical_1", *(f"{x},{y},1" for x in range(51) for y in (-1500, 1500))], MODES[:2],
     r"nodes.csv, row 2, column y: y must lie in \[-50, 50\], got -1500; give metres from the centre line"),
    (NODES, changed(MODES, r3="2,8.0,0.005,25"),
     r"modes.csv, row 3, column modal_mass: modal mass 25 / \(largest value 1\)² must lie in \[100, 1e\+08\], got 25; "
     "give kg, for the shapes as they are"),
    (column(NODES, 2, lambda z: str(float(z) / 158)), MODES,    # mass-normalised, and yet a modal mass
     r"modes.csv, row 3, column modal_mass: .* got 6.241e\+08; give kg, .* none for mass-normalised ones"),
    (NODES, ["mode,frequency,damping", "1,2.0,0.005", "2,8.0,0.005"],
     r"modes.csv, row 2, column modal_mass: modal mass 1 / .*, got 1; export mass-normalised shapes in 1/√kg, or give"),
    (NODES, changed(MODES, r2="1,2.0,0.5,25e3"),
     r"modes.csv, row 2, column damping: damping must lie in \[0, 0.2\), got 0.5; give a fraction, not percent"),
    (NODES, changed(MODES, r2="1,2000,0.005,25e3"),
     r"modes.csv, row 2, column frequency: frequency must lie in \[0.1, 50\], got 2000; give Hz"),
    (changed(NODES, r5="3,0.2,1e-3 m"), MODES,
     r"nodes.csv, row 5, column vertical_2: the cell must be a number, got '1e-3 m'; write it like 2.5e-3"),
    (changed(NODES, r5="3,0_2,0.1"), MODES,
     r"nodes.csv, row 5, column vertical_1: the cell must be a number, got '0_2'; write it like 2.5e-3"),
    (["x,y,vertical_1", *(f"{x / 100},{np.sin(x)},1" for x in range(5000))], MODES[:2],
     r"nodes.csv, columns x and y: every line .* same x, got 5000 nodes at 5000 x and 4974 y; export whole lines"),
    (column(NODES, 1, lambda z: str(1e200 * float(z))), MODES,
     r"modes.csv, row 2, column mode: the largest value of the shape must be a displacement or .*, got 1e\+200; see"),
    (changed(NODES, r5="3,,0.1"), MODES, r"nodes.csv, row 5, column vertical_1: the cell must be a number, got ''"),
    (changed(NODES, r5="3,nan,0.1"), MODES, r"row 5, column vertical_1: the cell must be finite, got nan; leave"),
    (changed(NODES, r5="3,0,2,0,1"), MODES,
     r"nodes.csv, row 5: the row must have a cell below each of the 3 heads, got 5; part cells by commas, and write"),
    (changed(NODES, r1="distance,vertical_1,vertical_2"), MODES,
     r"nodes.csv, row 1: the table must have a column 'x', got 'distance', 'vertical_1', 'vertical_2'; add it, or ren"),
    (changed(NODES, r1="x,vertical_1,UZ"), MODES, r"nodes.csv, row 1: the table must have a column 'vertical_2', got"),
    (NODES, changed(MODES, r1="mode,frequency,xi,modal_mass"), r"modes.csv, row 1: .* a column 'damping', got 'mode',"),
    (NODES, changed(MODES, r1="mode,frequency,damping,mass"),
     r"modes.csv, row 1, column 4: each column must be one of 'mode', 'frequency', .*'modal_mass', got 'mass'; rename"),
    (NODES, MODES[:2],
     r"nodes.csv, row 1, column 3: each column must be one of 'x', 'y', .*'lateral_1', got 'vertical_2'; rename it"),
    (changed(NODES, r1="x,vertical_1,vertical_1"), MODES,
     r"nodes.csv, row 1: each column must come once, got 'vertical_1' in columns 2 and 3; leave one out, or number"),
    (NODES, changed(MODES, r3="1,8.0,0.005,25e3"),
     r"modes.csv, row 3, column mode: rows must differ, got what row 2 holds; leave one of them out"),
    (column(NODES, 2, lambda z: str(float(z))), [*MODES, "3,8.0,0.005,25e3"], "must have a column 'vertical_3'"),
    (NODES, changed(MODES, r3="1.5,8.0,0.005,25e3"), r"row 3, column mode: mode must be a whole number, got 1.5; give"),
    (NODES, changed(MODES, r2="0,2.0,0.005,25e3"), r"row 2, column mode: mode must be at least 1, got 0; number"),
    (changed(NODES, r20="17,0.9,0.8"), MODES,
     r"nodes.csv, row 20, column x: rows must differ, got what row 19 holds; leave one of them out"),
    (changed(NODES, r20="17.01,0.9,0.8"), MODES,
     r"nodes.csv, mode 1: x must keep a distance of 0.05 of the longest, 1.99 m, got 17 and 17.01; leave"),
    (["x,vertical_1", *(f"{x},1" for x in (0, 10, 20, 30, 50))], MODES[:2],
     r"nodes.csv, mode 1: x must hold at least 6 number\(s\), got 5; give six places along the deck"),
    (column(NODES, 1, lambda z: "0.0"), MODES, r"nodes.csv, mode 1: a shape must move somewhere, got zeros alone"),
    (["x,y,vertical_1", *(f"{x},{y},1" for x in range(51) for y in (-1, 1) if (x, y) != (7, 1))], MODES[:2],
     r"nodes.csv, columns x and y: every line along the deck must have nodes at the same x, got none at x = 7, y = 1"),
    (["x,y,vertical_1", *(f"{x},{y},1" for x in range(51) for y in (0, 3))], MODES[:2],
     r"nodes.csv, row 2, column y: lines must lie on both sides of y = 0, got y from 0 to 3; count y from the centre"),
    (NODES[:1], MODES, r"nodes.csv: the table must hold a row of heads and rows of numbers, got 1 row\(s\); export"),
    ([], MODES, r"nodes.csv: the table must hold a row of heads and rows of numbers, got 0 row"),
    (['x,"vertical_1', *NODES[1:]], MODES, r"nodes.csv: the table must be CSV in UTF-8, got unexpected end of data"),
])
def test_refusals_name_file_row_and_column(tmp_path, nodes, modes, message):
    for name, lines in (("nodes.csv", nodes), ("modes.csv", modes)):
        (tmp_path / name).write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        read((tmp_path / "nodes.csv", tmp_path / "modes.csv"))


def test_a_mode_that_comes_again_under_another_number_is_refused(tmp_path):
    nodes = [f"{line},{line.split(',')[1] if i else 'lateral_3'}" for i, line in enumerate(column(NODES, 1, str))]
    assert nodes[0] == "x,vertical_1,vertical_2,lateral_3"
    (tmp_path / "nodes.csv").write_text("\n".join(nodes))
    modes = [*MODES, "3,2.0,0.005,25e3"]
    (tmp_path / "modes.csv").write_text("\n".join(modes))
    assert read((tmp_path / "nodes.csv", tmp_path / "modes.csv")).n_modes == 3     # a pair: one up, one aside
    (tmp_path / "nodes.csv").write_text("\n".join(nodes).replace("lateral_3", "vertical_3"))
    with pytest.raises(ValueError, match=r"modes.csv, row 4, column mode: modes must differ, got frequency and shape "
                                         "of mode 1 again; leave one of them out"):
        read((tmp_path / "nodes.csv", tmp_path / "modes.csv"))


def test_tables_as_spreadsheets_save_them(tmp_path):
    """A byte-order mark, blanks, an empty row at the end, Windows line ends."""
    for name, lines in (("nodes.csv", NODES), ("modes.csv", MODES)):
        (tmp_path / name).write_bytes(("\ufeff" + "\r\n".join(lines).replace(",", " , ") + "\r\n,,\r\n").encode())
    assert read((tmp_path / "nodes.csv", tmp_path / "modes.csv")).n_modes == 2


def test_files_that_are_missing_or_not_text(tmp_path):
    nodes, modes = export(tmp_path)
    with pytest.raises(ValueError, match=r"nothing.csv: the table must be a file that can be read, got No such file"):
        read((tmp_path / "nothing.csv", modes))
    nodes.write_bytes("x, ξ".encode("utf-16"))
    with pytest.raises(ValueError, match=r"nodes.csv: the table must be CSV in UTF-8, got .*; export it as text"):
        read((nodes, modes))


@pytest.mark.parametrize(("given", "message"), [
    ({"x": X + 1, "vertical": X}, "x must begin at 0, got 1; count it from the end of the deck"),
    ({"x": X[::-1], "vertical": X}, "x must increase, got 50 and then 49; sort the nodes"),
    ({"x": X, "y": [1.0, 1.0], "vertical": X}, "y must increase, got 1 and then 1; give one or more lines"),
    ({"x": X, "y": [0.5, 1.5], "vertical": X}, "y must hold lines on both sides of the centre line, got 0.5 to 1.5"),
    ({"x": X, "y": [-1.0, 1.0], "vertical": np.ones((2, 51))}, r"vertical must have shape \(51, 2\) or \(51,\), got "),
    ({"x": X}, "a shape must move somewhere, got zeros alone; give one of its components"),
])
def test_refusals_of_a_sampled_shape(given, message):
    with pytest.raises(ValueError, match=message):
        hsi.SampledShape(**given)


def test_refusals_of_what_is_asked_of_it():
    shape = hsi.SampledShape(x=X, vertical=X)
    with pytest.raises(ValueError, match="direction must be one of 'vertical', 'lateral', got 'up'"):
        shape(1.0, direction="up")
    with pytest.raises(ValueError, match="order must be at least 0, got -1; give 0, 1 or 2"):
        shape.derivative(1.0, order=-1)
    with pytest.raises(ValueError, match="order must be at most 5, the degree of the splines, got 6; give 0, 1 or 2"):
        shape.derivative(1.0, order=6)
