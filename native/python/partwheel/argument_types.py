# SPDX-License-Identifier: GPL-3.0-or-later
"""Types of the command line's arguments, and the options that all builds have. argparse shows the functions' names, or the
sentence of an ArgumentTypeError."""

from argparse import ArgumentParser, ArgumentTypeError, BooleanOptionalAction, Namespace
from typing import Any, Callable, Collection, Dict, List, Tuple

from .cut.joints import CLEARANCES, Insert
from .library import FillMethod, Mode
from .marks import KINDS


def some_of(known: Collection[str], *, or_none: bool = False) -> Callable[[str], List[str]]:
    """The type of a comma-separated list of known words, without duplicates. or_none : "none" stands for an empty list"""
    def choose(text: str) -> List[str]:
        names = [] if or_none and text == "none" else list(dict.fromkeys(text.split(",")))
        if not set(names) <= set(known):
            raise ArgumentTypeError(f"choose from {', '.join(known)}")
        return names
    return choose


def fill_methods(text: str) -> int:
    """"exact,points" -> the sum of their FillMethod values."""
    return sum(FillMethod[word.upper()] for word in some_of(list(map(str.lower, FillMethod.__members__)))(text.lower()))


def length(text: str) -> float:
    """A finite number of at least 0."""
    value = float(text)
    if not 0 <= value < float("inf"):
        raise ValueError(f"{text} is not a length")
    return value


def clearance(text: str) -> float:
    """A length, or the name of a material."""
    try:
        return CLEARANCES[text.lower()] if text.lower() in CLEARANCES else length(text)
    except ValueError:
        raise ArgumentTypeError(f"a clearance is a length or {', '.join(CLEARANCES)}") from None


def _lengths(text: str, separator: str, number: int, message: str) -> Tuple[float, ...]:
    """Some positive lengths."""
    values = tuple(map(length, text.split(separator)))
    if len(values) != number or not all(values):
        raise ArgumentTypeError(message)
    return values


def magnet(text: str) -> Insert:
    """"6x3": a diameter and a height."""
    return Insert(*_lengths(text, "x", 2, "give a diameter and a length, such as 6x3"))


def dowel(text: str) -> Insert:
    """"1.75x12": a diameter and a length, half of which is in each piece."""
    diameter, whole = magnet(text)
    return Insert(diameter, whole / 2)


def bed(text: str) -> Tuple[float, ...]:
    """Three positive lengths: "220,220,250"."""
    return _lengths(text, ",", 3, "a bed has three lengths, such as 220,220,250")


def density(text: str) -> float:
    """A finite number above 0."""
    value = length(text)
    if not value:
        raise ArgumentTypeError("a density is above 0")
    return value


def count(text: str) -> int:
    """A positive integer."""
    value = int(text)
    if value < 1:
        raise ValueError(f"{text} is less than 1")
    return value


def size(text: str) -> int:
    """A number of bytes: "6G" -> 6 * 2**30."""
    power = "KMGT".find(text[-1:].upper()) + 1
    return int(float(text[:-1]) * 1024 ** power) if text and power else int(text)


def shard(text: str) -> Tuple[int, int]:
    """(index, count): "2/8" -> (2, 8)."""
    before, _, after = text.partition("/")
    index, number = int(before), int(after)
    if not 1 <= index <= number:
        raise ArgumentTypeError("a shard is I/N with 1 <= I <= N, such as 2/8")
    return index, number


def add_build_options(build: ArgumentParser) -> None:
    """Adds the options of Hierarchy.build()."""
    build.add_argument("--quality", type=float, default=0.0, metavar="Q",
                       help="0: add no points inside the solid (default); 1.1 or more: add points until circumradius / shortest "
                            "edge of each tetrahedron is at most this, usually 1.4")
    build.add_argument("--fill-methods", default="exact,repaired,points,sheet", type=fill_methods, metavar="M,...",
                       help="the fill methods to try: exact, repaired, points, sheet (default: all); the first one that "
                            "works is used")
    build.add_argument("--open-surfaces", action=BooleanOptionalAction, default=True,
                       help="fill a mesh of nothing but sheets (plane, cloth, leaf) as thin solids (default), or report an error")
    build.add_argument("--threads", type=int, default=0, metavar="N", help="the most threads (default: automatic)")
    build.add_argument("--mode", choices=[mode.name.lower() for mode in Mode], default="learned",
                       help="learned: parts as people see them (default); paper: the paper's tree")
    build.add_argument("--full-resolution", action="store_true",
                       help="use all triangles of a mesh that has more than 200,000, not a coarser copy; takes about ten "
                            "times the time and memory")
    build.add_argument("--keep-inner-walls", action="store_true",
                       help="find parts on all walls of a shell with a double wall, not on the outer one")
    build.add_argument("--use", type=some_of(KINDS, or_none=True), default=[], metavar="K,...",
                       help=f"what in the file marks borders of parts: {', '.join(KINDS)}, or none (default)")


def build_options(options: Namespace) -> Dict[str, Any]:
    """The arguments of Hierarchy.build() that affect its result, as JSON values."""
    return {name: getattr(options, name) for name in ("quality", "fill_methods", "open_surfaces", "mode", "full_resolution",
                                                      "keep_inner_walls")}
