"""Sheets and movies show the frames, and never cost a file."""

from __future__ import annotations

import subprocess
import sys
import zlib
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import snell
from snell.movie import png

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


@pytest.mark.parametrize("ending", [".png", ".webp", ".mp4"])
def test_rates_of_television_are_exact(frames: snell.Sweep, ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"movie{ending}"
    frames.save(path, fps=Fraction(30000, 1001))
    if ending == ".png":
        data = path.read_bytes()
        delay = data[data.index(b"fcTL") + 24 :]
        assert (int.from_bytes(delay[:2], "big"), int.from_bytes(delay[2:4], "big")) == (1001, 30000)
    elif ending == ".mp4":
        with av.open(str(path)) as file:
            assert file.streams.video[0].average_rate == Fraction(30000, 1001)
    assert len(decoded(path)) == 5


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
    shown = frames._repr_png_()
    assert shown is not None
    assert shown.startswith(b"\x89PNG")
    assert snell.Sweep((tmp_path / "gone.png",), {})._repr_png_() is None


@pytest.mark.parametrize("ending", [*MOVIES, "sheet"])
def test_a_failure_leaves_what_was_there(frames: snell.Sweep, ending: str, tmp_path: Path) -> None:
    path = tmp_path / ("mine.png" if ending == "sheet" else f"mine{ending}")
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


@pytest.mark.parametrize("ending", MOVIES)
def test_a_frame_that_goes_meanwhile_is_named(
    frames: snell.Sweep, ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for wrong in (None, b"", frames[2].read_bytes()[:60]):
        gone = tmp_path / "0002.png"
        gone.write_bytes(frames[2].read_bytes())

        def check(_: object, gone: Path = gone, wrong: bytes | None = wrong) -> None:
            gone.unlink() if wrong is None else gone.write_bytes(wrong)

        monkeypatch.setattr(png, "check_alike", check)
        with pytest.raises(snell.PictureError, match="the same sweep again renders it anew") as error:
            snell.Sweep((*frames[:2], gone, *frames[3:]), {}).save(tmp_path / f"movie{ending}")
        assert error.value.place == str(gone)
        assert [path for path in tmp_path.iterdir() if path != gone] == []


def chunk(kind: bytes, content: bytes) -> bytes:
    """Return a chunk of a PNG with its right checksum."""
    return len(content).to_bytes(4, "big") + kind + content + zlib.crc32(kind + content).to_bytes(4, "big")


@pytest.mark.parametrize("ending", [*MOVIES, "sheet"])
def test_chunks_alone_are_no_picture(frames: snell.Sweep, ending: str, tmp_path: Path) -> None:
    signature, end = frames[0].read_bytes()[:8], chunk(b"IEND", b"")
    head, pixels = frames[0].read_bytes()[8:33], chunk(b"IDAT", zlib.compress(bytes(61 * (1 + 3 * 75))))
    wrong = {
        "end alone": end,
        "no head": pixels + end,
        "head later": pixels + head + end,
        "short head": chunk(b"IHDR", bytes(4)) + pixels + end,
        "no pixels": head + end,
    }
    for name, parts in wrong.items():
        path = tmp_path / f"{name}.png"
        path.write_bytes(signature + parts)
        assert not png.is_whole(path), name
        frame = snell.Sweep((path,), {})
        with pytest.raises(snell.PictureError, match="the same sweep again renders it anew") as error:
            frame.sheet() if ending == "sheet" else frame.save(tmp_path / f"movie{ending}")
        assert error.value.place == str(path)
    path = tmp_path / "right.png"
    path.write_bytes(signature + head + pixels + end)
    assert png.is_whole(path)


def test_a_frame_is_not_written_over(frames: snell.Sweep, tmp_path: Path) -> None:
    copy = tmp_path / "0000.png"
    copy.write_bytes(frames[0].read_bytes())
    (tmp_path / "link.png").symlink_to(copy)
    mine = snell.Sweep((copy, *frames[1:]), {})
    for path in (copy, tmp_path / "link.png"):
        for write in (mine.save, mine.sheet):
            with pytest.raises(snell.PictureError, match="is a frame of this very sweep"):
                write(path)
    assert copy.read_bytes() == frames[0].read_bytes()


def test_what_cannot_be_saved_is_said(frames: snell.Sweep, tmp_path: Path) -> None:
    with pytest.raises(snell.PictureError, match=r"known are \.mp4, \.gif, \.webp, \.apng, \.png"):
        frames.save(tmp_path / "movie.mov")
    with pytest.raises(snell.PictureError, match="a GIF cannot be faster"):
        frames.save(tmp_path / "movie.gif", fps=60)
    with pytest.raises(snell.PictureError, match=r"no sheet has this ending \(known is \.png\)"):
        frames.sheet(tmp_path / "sheet.jpg")
    for fps in (0, -1, float("nan"), "fast", True, np.bool_(True)):
        with pytest.raises(snell.PictureError, match=r"fps: expected 0\.1 to 240 frames per second"):
            frames.save(tmp_path / "movie.mp4", fps=fps)  # type: ignore[arg-type]
    with pytest.raises(snell.PictureError, match="there are no frames"):
        frames[:0].save(tmp_path / "movie.gif")
    with pytest.raises(snell.PictureError, match="at least 1"):
        frames.sheet(columns=0)
    with pytest.raises(snell.PictureError, match="at least 1, read True"):
        frames.sheet(columns=True)
    with pytest.raises(TypeError, match="unhashable type: 'Sweep'"):
        hash(frames)
    other = snell.sweep(snell.scenes["lecture/default"], {}, tmp_path / "other", width=32)
    with pytest.raises(snell.PictureError, match="has 32 x 32 pixels, the first frame has 75 x 61"):
        snell.Sweep((*frames, *other), {}).save(tmp_path / "movie.gif")


@pytest.mark.parametrize(("module", "library"), [("av", "PyAV"), ("PIL", "Pillow")])
def test_without_a_library_it_says_what_to_install(frames: snell.Sweep, module: str, library: str) -> None:
    script = f"""
import sys
sys.modules[{module!r}] = None
import snell
from pathlib import Path
frames = snell.Sweep((Path({str(frames[0])!r}),), {{}})
assert (frames._repr_png_() is None) == ({module!r} == "PIL")
try:
    frames.save("movie.gif") if {module!r} == "av" else frames.sheet()
except snell.PictureError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert done.stdout.startswith(f"this needs {library}: ")
    assert done.stdout.endswith("(pip install 'snell[movie]')\n")
