"""Traffic in files: back to the last bit, whole or not at all, and nothing else taken for it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import hsictrl as hsi
from tests.test_trajectories import BRIDGE, COSINES, MODELS, ROOT, STRAIGHT, WANDERERS, read, walker


def crossing(force: hsi.WalkingForce) -> hsi.Traffic:
    return hsi.CrowdFlow(density=0.3).sample(BRIDGE, rng=np.random.default_rng(3), force=force)


SAVED = {
    "narrow band": lambda: crossing(hsi.ZivanovicForce()),
    "narrow band, finer": lambda: crossing(hsi.ZivanovicForce(spacing=0.25 / 30, scaling="variance")),
    "periodic": lambda: crossing(hsi.ZivanovicForce().periodic()),
    "Young": lambda: crossing(hsi.YoungForce(values="design")),
    "harmonic": lambda: crossing(COSINES),
    "by hand": lambda: hsi.Traffic([STRAIGHT, walker(speed=1.1, force=hsi.YoungForce())], rng=np.random.default_rng(1),
                                   window=(1 / 3, 30.0)),
    "wandering": lambda: hsi.Traffic(WANDERERS[:4]),
    "recorded": lambda: read(ROOT / "examples" / "filmed.txt"),
    "part": lambda: crossing(hsi.ZivanovicForce()).since(-20.0).tuned(1.9),
}


@pytest.mark.parametrize("name", SAVED)
def test_traffic_comes_back_to_the_last_bit(name: str, tmp_path: Path) -> None:
    ours = SAVED[name]()
    ours.save(tmp_path / "traffic.npz")
    theirs = hsi.Traffic.load(str(tmp_path / "traffic.npz"))
    for one in ("window", "target", "spread", "drawn_from"):
        assert getattr(theirs, one) == getattr(ours, one)
    for model in MODELS:
        np.testing.assert_array_equal(*(hsi.predict(model, BRIDGE, one).response.y for one in (theirs, ours)))


@pytest.mark.parametrize("time", [np.int64(-3), np.float32(-3.0)])
def test_numbers_of_numpy_are_numbers(time, tmp_path: Path) -> None:
    hsi.Traffic([STRAIGHT], drawn_from=time).save(tmp_path / "traffic.npz")
    assert hsi.Traffic.load(tmp_path / "traffic.npz").drawn_from == -3.0


def test_a_file_appears_when_all_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, two = tmp_path / "traffic.npz", hsi.Traffic([STRAIGHT, STRAIGHT])
    hsi.Traffic([STRAIGHT]).save(path)

    def full(file, **arrays) -> None:
        file.write(b"half of it")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez", full)
    with pytest.raises(ValueError, match=r"traffic\.npz: the file must be one that can be written, got No space left"):
        two.save(path)
    monkeypatch.undo()
    assert [one.name for one in tmp_path.iterdir()] == ["traffic.npz"]
    assert len(hsi.Traffic.load(path).walkers) == 1
    old = path.read_bytes()
    with path.open("rb") as reader:     # whoever reads meanwhile reads the old file to its end
        two.save(path)
        assert reader.read() == old
    assert len(hsi.Traffic.load(path).walkers) == 2


def with_head(path: Path, **changes) -> Path:
    """A file of `save`, changed."""
    hsi.Traffic([STRAIGHT]).save(path)
    with np.load(path) as file:
        arrays = {name: file[name] for name in file.files}
    head = json.loads(arrays["head"].item()) | {key: value for key, value in changes.items() if key != "drop"}
    np.savez(path, **{name: array for name, array in arrays.items() if name != changes.get("drop")}
             | {"head": np.array(json.dumps(head))})
    return path


def test_other_files_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "traffic.npz"
    ours = "the file must be one that Traffic.save has written, got another"
    for content in (b"", b"some text", b"PK\x03\x04 half a zip"):
        path.write_bytes(content)
        with pytest.raises(ValueError, match=ours):
            hsi.Traffic.load(path)
    np.savez(path, a=1.0)
    with pytest.raises(ValueError, match=ours):
        hsi.Traffic.load(path)
    np.savez(path, head=np.array({"mark": 1}, dtype=object))
    with pytest.raises(ValueError, match=ours):
        hsi.Traffic.load(path)
    with pytest.raises(ValueError, match=ours):
        hsi.Traffic.load(with_head(path, mark="other"))
    for flag in (1, 32):      # a flipped bit in the header of a ZIP tells of a secret, or of a patch
        hsi.Traffic([STRAIGHT]).save(path)
        damaged = bytearray(path.read_bytes())
        damaged[damaged.rindex(b"PK\x01\x02") + 8] ^= flag
        damaged[damaged.index(b"PK\x01\x02") + 8] ^= flag
        path.write_bytes(damaged)
        with pytest.raises(ValueError, match=ours):
            hsi.Traffic.load(path)
    with pytest.raises(ValueError, match="must be of format 1, got 2; read it with the version of hsictrl that wrote"):
        hsi.Traffic.load(with_head(path, format=2))
    with pytest.raises(ValueError, match=r"must hold what Traffic\.save has written, got damage: 'speed'"):
        hsi.Traffic.load(with_head(path, drop="speed"))
    with pytest.raises(ValueError, match="got damage: 'Hopping'"):
        hsi.Traffic.load(with_head(path, forces=[{"kind": "Hopping"}]))


class Hop(hsi.WalkingForce):
    n_draws = 0

    def parts(self, weight, draws):
        return COSINES.parts(weight, draws)

    def periodic(self):
        return self


@pytest.mark.parametrize(("call", "message"), [
    (lambda: hsi.Traffic([STRAIGHT]).save("/no/such/folder/a.npz"), "must be one that can be written, got No such"),
    (lambda: hsi.Traffic([STRAIGHT]).save(""), "the file must have a name, got none; choose one"),
    (lambda: hsi.Traffic([STRAIGHT]).save("a" * 300), "must be one that can be written, got File name too long"),
    (lambda: hsi.Traffic([STRAIGHT]).save(3), "path must be of type str or Path, got int"),
    (lambda: hsi.Traffic.load(3), "path must be of type str or Path, got int"),
    (lambda: hsi.Traffic.load(ROOT), "the traffic must be a file that can be read, got Is a directory"),
    (lambda: hsi.Traffic([walker(speed=1.0, force=Hop())]).save("a.npz"), "only forces of hsictrl can be saved"),
])
def test_refusals(call, message: str) -> None:
    with pytest.raises((TypeError, ValueError), match=message):
        call()
