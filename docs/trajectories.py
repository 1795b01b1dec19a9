"""The two recordings of the page trajectories.md: nobody was filmed, and no simulator ran.

`python docs/trajectories.py` writes examples/simulated.sqlite, in the tables of JuPedSim, and examples/filmed.txt, in
the columns of PeTrack and PedPy: the same people, who cross 50 m at speeds of their own.
"""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

import numpy as np

EXAMPLES = Path(__file__).parent.parent / "examples"
RATE = 1.0      # frames per second, so that the files are small
# arrival [s], speed [m/s], its sign the direction, offset [m], and where and how long they stop [m, s]
PEOPLE = [(0.0, 1.3, -0.5, None), (4.0, -1.1, 0.6, None), (6.5, 1.5, 0.2, (30.0, 15.0)), (12.0, 1.2, -0.9, None)]


def crossing(arrival, speed, offset, stop):
    """Frames and places of somebody who is seen from 2 m before the deck until 2 m behind it, and sways."""
    x, times = np.array([-2.0, 52.0]), np.array([0.0, 54.0 / abs(speed)])
    if stop is not None:
        place, rest = stop
        reached = (place + 2.0) / speed
        x, times = np.array([-2.0, place, place, 52.0]), np.array([0.0, reached, reached + rest, times[1] + rest])
    frames = np.arange(np.ceil(RATE * arrival), RATE * (arrival + times[-1]))
    along = np.interp(frames / RATE - arrival, times, x)
    return frames.astype(int), along if speed > 0 else 50.0 - along, offset + 0.03 * np.sin(np.pi * frames / 3)


def rows(people=PEOPLE):
    """Person, frame, x and y along the deck to a millimetre [m], frame by frame."""
    found = [(k, int(frame), round(float(x), 3), round(float(y), 3)) for k, one in enumerate(people, start=1)
             for frame, x, y in zip(*crossing(*one), strict=True)]
    return sorted(found, key=lambda row: (row[1], row[0]))


def write_jupedsim(path, rows, rate=RATE):
    """Tables trajectory_data and metadata; the deck runs along the x axis."""
    path.unlink(missing_ok=True)
    with closing(sqlite3.connect(path)) as file, file:
        file.execute("PRAGMA page_size = 1024")
        file.execute("CREATE TABLE trajectory_data (frame INTEGER NOT NULL, id INTEGER NOT NULL, pos_x REAL NOT NULL, "
                     "pos_y REAL NOT NULL, ori_x REAL NOT NULL, ori_y REAL NOT NULL)")
        file.execute("CREATE TABLE metadata (key TEXT NOT NULL UNIQUE PRIMARY KEY, value TEXT NOT NULL)")
        file.executemany("INSERT INTO metadata VALUES (?, ?)", [("version", "2"), ("fps", str(rate))])
        file.executemany("INSERT INTO trajectory_data VALUES (?, ?, ?, ?, 1.0, 0.0)",
                         [(frame, person, x, y) for person, frame, x, y in rows])


def write_text(path, rows, rate=RATE):
    """Columns id, frame, x, y and z in centimetres; the deck begins at (12, 3) m and runs along the y axis."""
    head = [f"# framerate: {rate:.2f}", "# id frame x/cm y/cm z/cm"]
    lines = [f"{person} {frame} {1200 - 100 * y:.12g} {300 + 100 * x:.12g} 170" for person, frame, x, y in rows]
    path.write_text("\n".join([*head, *lines]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    write_jupedsim(EXAMPLES / "simulated.sqlite", rows())
    write_text(EXAMPLES / "filmed.txt", rows())
