"""Times Snell and its peers by turns, in one run, and keeps the results:   python3 benches/peers/run.py [ROUNDS]

Each round asks every program once for everything; a ratio is taken within a round, so that a slow minute of the machine
slows both. Then `benches/report.py` writes the page.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from povray import PovRay
from record import ROOT, SCRATCH, WORKER, Answer, Others, Worker, origin, output_of, quiet, save

KINDS = ("primary", "shadow", "bounce")
EMBREE = {
    "primary": ("16 coherent",),
    "shadow": ("16 coherent",),
    "bounce": ("1 incoherent", "8 incoherent", "16 incoherent"),
}
# What is asked of Snell on one and on two threads.
FRAMES = {"default": "frame default 2048 6", "sphereflake": "frame flake:5 512 4"}
# What is asked of Snell on one thread.
GLASS = {"glass": "frame glass:off 512 7", "light through glass": "frame glass:tinted 512 7"}
RAYS = {kind: f"rays {kind}" for kind in KINDS}


@dataclass
class Timing:
    """One question to one program, and its answers, a round each."""

    program: str
    question: str
    answers: list[Answer] = field(default_factory=list)

    @property
    def seconds(self) -> list[float]:
        return [answer["seconds"] for answer in self.answers]


class Run:
    def __init__(self, programs: dict) -> None:
        self.programs = programs
        self.timings: list[Timing] = []

    def add(self, program: str, question: str) -> Timing | None:
        """Plans a question; nothing where the program is missing."""
        if program not in self.programs:
            return None
        self.timings.append(Timing(program, question))
        return self.timings[-1]

    def go(self, rounds: int) -> None:
        for timing in self.timings:  # prepares scenes and touches memory
            if timing.program != "POV-Ray":
                self.programs[timing.program].ask(timing.question)
        for number in range(rounds):
            print(f"round {number + 1} of {rounds}", file=sys.stderr)
            # Every other round backwards, so that nobody always comes after the same other one.
            for timing in self.timings[:: -1 if number % 2 else 1]:
                quiet()
                timing.answers.append(self.programs[timing.program].ask(timing.question))


@dataclass
class Row:
    """A line of the table. `sense` is "at least" or "at most"."""

    number: str
    what: str
    peer: str
    sense: str
    goal: float

    def filled(self, above: Timing | None, below: Timing | None, value: str = "seconds", missing: str = "") -> dict:
        """With the ratios of two programs' answers, round by round, and that of their best ones; or with why not."""
        if above is None or below is None or missing:
            return vars(self) | {"ratios": None, "missing": missing or "not installed"}
        values = [a[value] / b[value] for a, b in zip(above.answers, below.answers)]
        best = min(a[value] for a in above.answers) / min(b[value] for b in below.answers)
        return vars(self) | {"ratios": values, "best": best, "value": value}


def agreement(kind: str, snell: Timing, embree: Timing) -> dict:
    """Do both find the same? Embree works in f32, with 24 bits: a ray in 10 000 may pass an edge on the other side, and
    mean distances agree to 1e-4."""
    ours, theirs = snell.answers[0], embree.answers[0]
    few = ours["rays"] * 1e-4
    near = abs(ours["mean_t"] - theirs["mean_t"]) <= 1e-4 * abs(ours["mean_t"])
    agree = ours["rays"] == theirs["rays"] and abs(ours["hits"] - theirs["hits"]) <= few and near
    return {"kind": kind, "snell": ours, "embree": theirs, "agree": agree}


def compare(name: str, pov: PovRay, snell: Worker) -> str:
    """What `snell diff` says of the two pictures of a scene."""
    theirs = pov.file(name).with_suffix(".png")
    scene, picture = (SCRATCH / theirs.name).with_suffix(".json"), SCRATCH / theirs.name
    snell.ask(f"scene {name} 512 {scene}")
    command = ROOT / "target" / "ci" / "snell"
    subprocess.run([command, "render", "--quiet", scene, "-o", picture], check=True)
    return output_of(str(command), "diff", str(picture), str(theirs))


def measure(rounds: int, programs: dict) -> dict:
    run = Run(programs)
    pairs, widths, two = {}, {}, {}
    both = (os.cpu_count() or 1) > 1
    for name, question in (FRAMES | GLASS).items():
        size = question.split()[2]
        pov = run.add("POV-Ray", f"frame {question.split()[1]} {size} 1")
        pairs[name] = (run.add("Snell", f"{question} 1"), pov)
        two[name] = run.add("Snell", f"{question} 2") if both and name in FRAMES else None
    for kind, question in RAYS.items():
        widths[kind] = [run.add("Embree", f"{question} {width} 1") for width in EMBREE[kind]]
        pairs[kind] = (run.add("Snell", f"{question} 1"), None)
        two[kind] = run.add("Snell", f"{question} 2") if both else None
    builds = run.add("Snell", "build knot 1"), run.add("Embree", "build")
    run.go(rounds)

    for kind in KINDS:
        timed = [timing for timing in widths[kind] if timing]
        best = min(timed, key=lambda timing: statistics.median(timing.seconds)) if timed else None
        pairs[kind] = (pairs[kind][0], best)

    agreed = [agreement(kind, *pairs[kind]) for kind in KINDS if pairs[kind][1]]
    wrong = {pair["kind"] for pair in agreed if not pair["agree"]}

    def faster(number: str, what: str, name: str, peer: str, goal: float) -> dict:
        missing = "they do not find the same" if name in wrong else ""
        return Row(number, what, peer, "at least", goal).filled(pairs[name][1], pairs[name][0], missing=missing)

    triangles = "on 1 000 002 triangles, 1024 x 1024"
    rows = [
        faster("1", "default scene, 2048 x 2048, depth 6, shadows", "default", "POV-Ray", 50),
        faster("2", "sphereflake, 66 430 spheres, 512 x 512, depth 4", "sphereflake", "POV-Ray", 12),
        faster("3", f"primary rays {triangles}", "primary", "Embree, 16 wide", 1),
        faster("4", "shadow rays, the same", "shadow", "Embree, 16 wide", 1),
        faster("5", "cosine bounce rays, the same", "bounce", "Embree, best width", 1),
        Row("6", "building the tree, the same mesh", "Embree, medium", "at most", 1.5).filled(*builds),
    ]
    for name in (*FRAMES, *KINDS):
        line = Row("7", f"two threads against one: {name}", "Snell", "at least", 1.85)
        rows.append(line.filled(pairs[name][0], two[name], missing="" if both else "one core only"))
    memory = Row("8", "memory of the built knot, mesh included", "Embree, medium", "at most", 1.5)
    rows.append(memory.filled(*builds, value="bytes"))
    knot = "glass knot, 100 000 triangles, 512 x 512, depth 7"
    rows.append(faster("9", f"{knot}, without shadows", "glass", "POV-Ray", 25))
    rows.append(faster("9", "the same, light falls through the glass", "light through glass", "POV-Ray", 25))

    result = {
        "rows": rows,
        "timings": [vars(timing) for timing in run.timings],
        "agreement": agreed,
    }
    if "POV-Ray" in programs:
        pictures = {"flakes": "flake:5", "glass": "glass:off"}
        result |= {key: compare(name, programs["POV-Ray"], programs["Snell"]) for key, name in pictures.items()}
    return result


def build_embree() -> tuple[Path, str] | None:
    """The program and the library's version, or nothing where there is no compiler or no library."""
    program = SCRATCH / "embree"
    source = ROOT / "benches" / "peers" / "embree.cpp"
    command = ["g++", "-O3", "-march=native", "-std=c++17", str(source), "-o", str(program), "-lembree3", "-lpthread"]
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except FileNotFoundError:
        return None
    if done.returncode:
        print(f"Embree is left out: {done.stderr.splitlines()[0]}", file=sys.stderr)
        return None
    numbers = output_of("sh", "-c", "echo '#include <embree3/rtcore_config.h>\nRTC_VERSION_STRING' | g++ -E -P -")
    return program, "Embree " + numbers.splitlines()[-1].strip('"')


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 7
    SCRATCH.mkdir(parents=True, exist_ok=True)
    others, about = Others(), origin()
    programs: dict = {"Snell": Worker(WORKER)}
    peers = []
    if version := PovRay.version():
        programs["POV-Ray"] = PovRay(SCRATCH / "povray")
        peers.append(version)
    if found := build_embree():
        programs["Snell"].ask(f"export {SCRATCH}")
        programs["Embree"] = Worker(found[0], SCRATCH)
        peers.append(found[1])
    result = measure(rounds, programs)
    for program in programs.values():
        if isinstance(program, Worker):
            program.close()
    save("peers", about | {"rounds": rounds, "peers": peers, "others": others.cores()} | result)
    wrong = [pair["kind"] for pair in result["agreement"] if not pair["agree"]]
    if wrong:
        sys.exit(f"Snell and Embree do not find the same with {' and '.join(wrong)} rays: no ratios for them")


if __name__ == "__main__":
    main()
