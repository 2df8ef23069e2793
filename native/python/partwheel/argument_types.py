# SPDX-License-Identifier: GPL-3.0-or-later
"""Types of the command line's arguments. argparse shows the functions' names, or the sentence of an ArgumentTypeError."""

from argparse import ArgumentTypeError
from typing import Callable, Collection, List, Tuple

from .cut.joints import CLEARANCES, Insert
from .library import FillMethod


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
