"""How cost grows with spheres, pixels and depth, and whether memory does not:   python3 benches/growth.py [LARGEST]

One thread. Every point has a process of its own, so that its peak of memory is its own. LARGEST, 8192 if not given, is
the side of the largest picture; its film alone takes 25 bytes a pixel.
"""

from __future__ import annotations

import sys
from contextlib import closing

from record import WORKER, Others, Worker, origin, quiet, save

# A point is timed again until this many seconds are spent, but at most five times.
ENOUGH = 2.0
BYTES_PER_PIXEL = 25  # three numbers of 8 bytes and one byte


def frame(scene: str, size: int, depth: int) -> dict[str, float]:
    seconds: list[float] = []
    with closing(Worker(WORKER)) as worker:
        while not seconds or (sum(seconds) < ENOUGH and len(seconds) < 5):
            quiet()
            answer = worker.ask(f"frame {scene} {size} {depth} 1")
            seconds.append(answer["seconds"])
    return {"seconds": min(seconds), "rays": answer["rays"], "peak_bytes": answer["peak_bytes"]}


def build(scene: str) -> dict[str, float]:
    with closing(Worker(WORKER)) as worker:
        answers = [worker.ask(f"build {scene} 1") for _ in range(3)]
    return {"seconds": min(answer["seconds"] for answer in answers), "bytes": answers[0]["bytes"]}


def main() -> None:
    largest = int(sys.argv[1]) if len(sys.argv) > 1 else 8192
    others, about = Others(), origin()
    counts = [10**n for n in range(2, 7)]
    sizes = [size for size in (256, 512, 1024, 2048, 4096, 8192) if size <= largest]
    depths = [0, 1, 2, 4, 8, 16, 32]
    content = {
        "spheres": [{"x": n, "build": build(f"spheres:{n}"), "frame": frame(f"spheres:{n}", 512, 2)} for n in counts],
        "pixels": [{"x": n, "frame": frame("default", n, 6), "film_bytes": n * n * BYTES_PER_PIXEL} for n in sizes],
        "depth": [{"x": n, "frame": frame("spheres:100000", 512, n)} for n in depths],
    }
    save("growth", about | {"others": others.cores()} | content)


if __name__ == "__main__":
    main()
