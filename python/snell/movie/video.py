"""Frames as GIF, WebP and MP4, by PyAV. One frame at a time is in memory, and what the encoder keeps."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from pathlib import Path

import av
import av.filter
import numpy as np
from av.codec.codec import UnknownCodecError
from av.filter.context import FilterContext
from av.video.frame import PictureType
from av.video.stream import VideoStream

from ..errors import PictureError
from .png import damaged

_BT709, _16_TO_235 = 1, 1  # as HD television has its colours, which players assume
_CONTAINER = {"mp4": {"movflags": "+faststart"}, "webp": {"loop": "0"}, "gif": {"loop": "0"}}


def gif(frames: Sequence[Path], path: Path, fps: Fraction) -> None:
    """Write a GIF, with one palette of the colours of all frames: with one each, what stands still would flicker.

    Errors are spread to the neighbours, or 256 colours would show as steps on glass; but only where a frame differs
    from the one before.
    """
    [palette] = _filtered(_read(frames, fps), "palettegen", "stats_mode=full")
    colored = _filtered(_read(frames, fps), "paletteuse", "dither=sierra2_4a:diff_mode=rectangle", palette)
    _encode(colored, path, fps, ("gif", "gif"), {})


def webp(frames: Sequence[Path], path: Path, fps: Fraction) -> None:
    """Write a WebP with the very pixels of the frames."""
    exact = (_as(frame, "bgra") for frame in _read(frames, fps))
    _encode(exact, path, fps, ("webp", "libwebp_anim"), {"lossless": "1"})


def mp4(frames: Sequence[Path], path: Path, fps: Fraction) -> None:
    """Write H.264 for all players: of even size, with half the colours; a reader can start before it has all."""
    halved = (_as(_even(frame), "yuv420p") for frame in _read(frames, fps))
    # Bits are spent on smooth gradients, which are most of a picture of glass.
    _encode(halved, path, fps, ("mp4", "libx264"), {"crf": "16", "preset": "slow", "tune": "animation"})


def _read(frames: Sequence[Path], fps: Fraction) -> Iterator[av.VideoFrame]:
    for index, path in enumerate(frames):
        frame = _decoded(path)
        frame.pts, frame.time_base = index, 1 / fps
        frame.pict_type = PictureType.NONE  # else each frame of a movie would be stored as whole as its PNG
        yield frame


def _decoded(path: Path) -> av.VideoFrame:
    try:
        with av.open(str(path), format="png_pipe") as file:
            return _as(next(file.decode(video=0)), "rgb24")
    except (av.FFmpegError, StopIteration) as error:
        raise damaged(path, f"cannot be read: {getattr(error, 'strerror', None) or 'it has no pixels'}") from error


def _as(frame: av.VideoFrame, pixels: str) -> av.VideoFrame:
    television = {"dst_colorspace": _BT709, "dst_color_range": _16_TO_235} if pixels == "yuv420p" else {}
    changed = frame.reformat(format=pixels, **television)
    changed.pts, changed.time_base = frame.pts, frame.time_base
    return changed


def _even(frame: av.VideoFrame) -> av.VideoFrame:
    """Return a frame of even size, with its last column and row twice if need be."""
    if frame.width % 2 == frame.height % 2 == 0:
        return frame
    pixels = np.asarray(frame.to_ndarray(), np.uint8)
    pixels = np.pad(pixels, ((0, frame.height % 2), (0, frame.width % 2), (0, 0)), mode="edge")
    even = av.VideoFrame.from_ndarray(pixels, format="rgb24")
    even.pts, even.time_base = frame.pts, frame.time_base
    return even


def _encode(
    frames: Iterable[av.VideoFrame], path: Path, fps: Fraction, codec: tuple[str, str], options: dict[str, str]
) -> None:
    form, coder = codec
    try:
        with av.open(str(path), "w", format=form, options=_CONTAINER[form]) as file:
            stream = file.add_stream(coder, rate=fps, options=options)
            assert isinstance(stream, VideoStream), "all of these codecs are of pictures"
            for frame in frames:
                if frame.pts == 0:
                    stream.width, stream.height, stream.pix_fmt = frame.width, frame.height, frame.format.name
                    if stream.pix_fmt == "yuv420p":
                        context = stream.codec_context
                        context.colorspace = context.color_primaries = context.color_trc = _BT709
                        context.color_range = _16_TO_235
                file.mux(stream.encode(frame))
            file.mux(stream.encode(None))
    except UnknownCodecError as error:
        raise PictureError([(None, f"PyAV was built without {coder}", "pip install --force-reinstall av")]) from error
    except av.FFmpegError as error:
        if isinstance(error, OSError):  # of the file
            raise
        raise PictureError([(None, f"{coder} cannot encode these frames: {error.strerror}", None)]) from error


def _filtered(
    frames: Iterator[av.VideoFrame], name: str, options: str, palette: av.VideoFrame | None = None
) -> Iterator[av.VideoFrame]:
    """Give what a filter makes of frames."""
    first = next(frames)
    graph = av.filter.Graph()
    inputs = [
        graph.add_buffer(width=frame.width, height=frame.height, format=frame.format, time_base=first.time_base)
        for frame in (first, palette)
        if frame is not None
    ]
    filtered, sink = graph.add(name, options), graph.add("buffersink")
    for index, source in enumerate(inputs):
        source.link_to(filtered, 0, index)
    filtered.link_to(sink)
    graph.configure()
    if palette is not None:
        palette.pts, palette.time_base = 0, first.time_base
        inputs[1].push(palette)
        inputs[1].push(None)
    for frame in itertools.chain([first], frames, [None]):
        inputs[0].push(frame)
        yield from _ready(sink)


def _ready(sink: FilterContext) -> Iterator[av.VideoFrame]:
    try:
        while True:
            frame = sink.pull()
            assert isinstance(frame, av.VideoFrame), "a filter of pictures makes pictures"
            yield frame
    except (BlockingIOError, EOFError):  # it waits for the next frame, or has given all
        return
