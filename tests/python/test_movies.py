"""Sheets and movies show the frames, and never cost a file."""

from __future__ import annotations

import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import snell

MOVIES = [".gif", ".png", ".apng", ".webp", ".mp4"]


@pytest.fixture(scope="module")
def frames(tmp_path_factory: pytest.TempPathFactory) -> snell.Sweep:
    """Five frames of odd size."""
    values = {"material.glass.eta": np.linspace(1, 2.5, 5)}
    folder = tmp_path_factory.mktemp("frames")
    return snell.sweep(snell.scenes["lecture/default"], values, folder, width=75, height=61, spp=4)


def decoded(path: Path) -> list[NDArray[np.int64]]:
    """Read a movie."""
    if path.suffix == ".mp4":
        with av.open(str(path)) as file:
            return [np.asarray(frame.to_ndarray(format="rgb24"), np.int64) for frame in file.decode(video=0)]
    pictures = []
    with Image.open(path) as movie:
        for index in range(getattr(movie, "n_frames", 1)):
            movie.seek(index)
            pictures.append(np.asarray(movie.convert("RGB"), np.int64))
    return pictures


@pytest.mark.parametrize("ending", MOVIES)
def test_a_movie_shows_the_frames(frames: snell.Sweep, ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"movie{ending.upper()}"
    path.write_text("what was there before")
    frames.save(path, fps=10)
    path = path.rename(tmp_path / f"movie{ending}")
    shown = decoded(path)
    height, width = (62, 76) if ending == ".mp4" else (61, 75)
    assert {picture.shape for picture in shown} == {(height, width, 3)}
    originals = [np.asarray(Image.open(frame), np.int64) for frame in frames]
    for index, picture in enumerate(shown):
        errors = [np.abs(picture[:61, :75] - original) for original in originals]
        assert np.argmin([error.mean() for error in errors]) == index
        # Exact, but for 256 colours in GIF, and one colour for 2 x 2 pixels in MP4.
        assert errors[index].mean() <= {".gif": 1, ".mp4": 4}.get(ending, 0)
    assert [path.name for path in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("ending", MOVIES)
@pytest.mark.parametrize("fps", [29.97, 0.5])
def test_it_lasts_as_long_as_is_said(frames: snell.Sweep, ending: str, fps: float, tmp_path: Path) -> None:
    path = tmp_path / f"movie{ending}"
    frames.save(path, fps=fps)
    if ending == ".mp4":
        with av.open(str(path)) as file:
            rate = file.streams.video[0].average_rate
            assert rate is not None
            assert abs(rate - Fraction(fps)) < 0.001  # as the file has the time in 1/15360 s or finer
    else:
        seconds = []
        with Image.open(path) as movie:
            assert movie.info["loop"] == 0
            for index in range(5):
                movie.seek(index)
                movie.load()
                seconds.append(movie.info["duration"] / 1000)
        step = 0.01 if ending == ".gif" else 0.001  # s, in which the format counts
        assert all(abs(each - 1 / fps) <= step for each in seconds)


@pytest.mark.parametrize("ending", MOVIES)
def test_the_smallest_movie(ending: str, tmp_path: Path) -> None:
    frame = snell.sweep(snell.scenes["lecture/default"], {}, tmp_path / "frames", width=1)
    frame.save(tmp_path / f"movie{ending}")
    assert len(decoded(tmp_path / f"movie{ending}")) == 1
    assert frame.sheet().size[0] >= 1


def test_mp4_plays_everywhere(frames: snell.Sweep, tmp_path: Path) -> None:
    frames.save(tmp_path / "movie.mp4")
    start = (tmp_path / "movie.mp4").read_bytes()
    assert start.index(b"moov") < start.index(b"mdat"), "the index comes first"
    with av.open(str(tmp_path / "movie.mp4")) as file:
        stream = file.streams.video[0]
        assert (stream.codec_context.name, stream.codec_context.pix_fmt) == ("h264", "yuv420p")
        shown = list(file.decode(video=0))
    kinds = [frame.key_frame for frame in shown]
    assert kinds == [True, False, False, False, False], "frames are stored as differences"
    # Brightness as BT.709 has it, from 16 to 235: rounding and compression are off by less than 1 on average, the
    # weights of BT.601 by 2 and more, 0 to 255 by 13.
    brightness = 16 + np.asarray(Image.open(frames[4])) @ [0.2126, 0.7152, 0.0722] * 219 / 255
    assert np.abs(shown[4].to_ndarray()[:61, :75] - brightness).mean() < 1


def test_a_sheet_shows_all_frames(frames: snell.Sweep, tmp_path: Path) -> None:
    sheet = frames.sheet(tmp_path / "sheet.png", columns=2)
    assert np.array_equal(np.asarray(Image.open(tmp_path / "sheet.png")), np.asarray(sheet))
    pixels = np.asarray(sheet)
    gap = round(75 * 0.07)
    step = (pixels.shape[0] - gap) // 3
    for index, frame in enumerate(frames):
        top, left = gap + index // 2 * step, gap + index % 2 * (75 + gap)
        assert np.array_equal(pixels[top : top + 61, left : left + 75], np.asarray(Image.open(frame)))
        label = pixels[top + 61 : top + step - gap, left : left + 75]
        assert label.max() == 255
        assert label.min() < 80, "nothing is written"
    assert (pixels[gap + 2 * step :, gap + 75 :] == 255).all(), "there is no sixth frame"


def test_a_sheet_of_many_frames_is_a_selection(frames: snell.Sweep) -> None:
    many = snell.Sweep(frames.frames * 40, {"eta": list(range(200))})
    assert frames.sheet(columns=1).size == many[:5].sheet(columns=1).size
    assert many.sheet(columns=1).size == many[:60].sheet(columns=1).size


def test_notebooks_show_a_sheet(frames: snell.Sweep, tmp_path: Path) -> None:
    png = frames._repr_png_()
    assert png is not None
    assert png.startswith(b"\x89PNG")
    assert snell.Sweep((tmp_path / "gone.png",), {})._repr_png_() is None


@pytest.mark.parametrize("ending", [*MOVIES, "sheet"])
def test_a_failure_leaves_what_was_there(frames: snell.Sweep, ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"mine{ending}"
    path.write_text("mine")
    damaged = tmp_path / "0004.png"
    damaged.write_bytes(frames[4].read_bytes()[:-200])
    some = snell.Sweep((*frames[:4], damaged), {})
    with pytest.raises(snell.PictureError, match="the same sweep again renders it anew") as error:
        some.sheet(path) if ending == "sheet" else some.save(path)
    assert error.value.place == str(damaged)
    assert path.read_text() == "mine"
    with pytest.raises(snell.PictureError, match="cannot be written"):
        frames.sheet(damaged / path.name) if ending == "sheet" else frames.save(damaged / path.name)
    with pytest.raises(snell.PictureError, match="cannot be written"):
        frames.sheet(tmp_path / "no" / path.name) if ending == "sheet" else frames.save(tmp_path / "no" / path.name)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["0004.png", path.name]


def test_what_cannot_be_saved_is_said(frames: snell.Sweep, tmp_path: Path) -> None:
    with pytest.raises(snell.PictureError, match=r"known are \.mp4, \.gif, \.webp, \.apng, \.png"):
        frames.save(tmp_path / "movie.mov")
    with pytest.raises(snell.PictureError, match="a GIF cannot be faster"):
        frames.save(tmp_path / "movie.gif", fps=60)
    for fps in (0, -1, float("nan"), "fast"):
        with pytest.raises(snell.PictureError, match=r"fps: expected 0\.1 to 240 frames per second"):
            frames.save(tmp_path / "movie.mp4", fps=fps)  # type: ignore[arg-type]
    with pytest.raises(snell.PictureError, match="there are no frames"):
        frames[:0].save(tmp_path / "movie.gif")
    with pytest.raises(snell.PictureError, match="at least 1"):
        frames.sheet(columns=0)
    other = snell.sweep(snell.scenes["lecture/default"], {}, tmp_path / "other", width=32)
    with pytest.raises(snell.PictureError, match="has 32 x 32 pixels, the first frame has 75 x 61"):
        snell.Sweep((*frames, *other), {}).save(tmp_path / "movie.gif")


def test_without_the_libraries_it_says_what_to_install(frames: snell.Sweep) -> None:
    script = f"""
import sys
sys.modules["av"] = sys.modules["PIL"] = None
import snell
from pathlib import Path
frames = snell.Sweep((Path({str(frames[0])!r}),), {{}})
assert frames._repr_png_() is None
for make in (frames.sheet, lambda: frames.save("movie.gif")):
    try:
        make()
    except snell.PictureError as error:
        print(error.help)
"""
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert done.stdout == "pip install 'snell[movie]'\n" * 2
