"""Unrolls loops of shaders: `#pragma unroll` before a `for` whose bounds are constants.

Mesa's software renderer reads `kernel[i]` with a constant index much faster than with the index of a loop, and tests no
condition between the copies. The pragma changes no result. A line `#pragma unroll off` anywhere in a shader or its
includes leaves all its loops as they are.
"""

import os
import re

from ..errors import ShaderError

# Loops of more turns stay loops: 64 directions took 1.4 s to compile, 32 took 0.6 s (llvmpipe, ssao).
MOST_COPIES = 32
# A direction has a loop over its `steps`, which Mesa unrolls itself. ssao compiled in 0.6 s with 16 directions of 8
# steps, and not within 100 s with 16 directions of 12 steps. As a loop, 16 of 16 took 0.1 s (llvmpipe, LLVM 15).
INNER, MOST_TAPS = "steps", 64
VARIABLE = "AOLAB_UNROLL"  # of the environment: another limit; 0 halves the time of compiling

_PRAGMA = re.compile(r"^\s*#\s*pragma\s+unroll\s*(?://.*)?$")
_OFF = re.compile(r"^\s*#\s*pragma\s+unroll\s+off\b")
_CONSTANT = re.compile(r"^\s*const\s+int\s+(\w+)\s*=\s*(-?\d+)\s*;")
_FOR = re.compile(r"^\s*for \(int (\w+) = (-?\w+); \1 (<=?) (\w+); \+\+\1\) \{\s*(?://.*)?$")
_JUMP = re.compile(r"\b(?:break|continue)\b")
_COMMENT = re.compile(r"//.*")

Line = tuple[str, tuple[str, int]]  # a line of GLSL, with its file and line number


def unrolled(lines: list[Line]) -> list[Line]:
    """The lines, with a copy of a loop's body for each of its turns where the pragma is above it.

    Raises `ShaderError` where the pragma is above anything but `for (int NAME = CONSTANT; NAME < CONSTANT; ++NAME) {`,
    or the loop is left by `break` or `continue`.
    """
    return _unrolled(lines, 0 if any(_OFF.match(text) for text, _ in lines) else _most())


def _most() -> int:
    value = os.environ.get(VARIABLE, str(MOST_COPIES))
    if not value.isdecimal():
        raise ShaderError(f"{VARIABLE} = '{value}' in the environment is not a whole number from 0 on")
    return int(value)


def _unrolled(lines: list[Line], most: int) -> list[Line]:
    constants: dict[str, int] = {}
    result: list[Line] = []
    i = 0
    while i < len(lines):
        text, place = lines[i]
        if match := _CONSTANT.match(text):
            constants[match[1]] = int(match[2])
        if _PRAGMA.match(text):
            name, turns = _loop(lines[i + 1][0] if i + 1 < len(lines) else "", constants, place)
            end = _end(lines, i + 1, place)
            if len(turns) <= most and len(turns) * constants.get(INNER, 1) <= MOST_TAPS:
                body = _unrolled(lines[i + 2 : end], most)
                for turn in turns:
                    result += [(f"{{ const int {name} = {turn};", lines[i + 1][1]), *body, ("}", lines[end][1])]
                i = end
        else:
            result.append((text, place))
        i += 1
    return result


def _loop(text: str, constants: dict[str, int], place: tuple[str, int]) -> tuple[str, range]:
    """The loop's variable and its values."""
    match = _FOR.match(text)
    bounds = [_value(bound, constants) for bound in (match[2], match[4])] if match else []
    if not match or None in bounds:
        raise ShaderError(
            f"{place[0]}:{place[1]}: #pragma unroll stands before for (int NAME = CONSTANT; NAME < CONSTANT; ++NAME) "
            f"{{, not before: {text.strip()}"
        )
    start, end = bounds
    assert start is not None
    assert end is not None
    return match[1], range(start, end + (match[3] == "<="))


def _value(text: str, constants: dict[str, int]) -> int | None:
    sign, name = (-1, text[1:]) if text.startswith("-") else (1, text)
    value = int(name) if name.isdecimal() else constants.get(name)
    return None if value is None else sign * value


def _end(lines: list[Line], start: int, place: tuple[str, int]) -> int:
    """The index of the line with the brace that closes the loop, which stands alone."""
    depth = 0
    for i in range(start, len(lines)):
        text, here = lines[i]
        code = _COMMENT.sub("", text)
        depth += code.count("{") - code.count("}")
        if _JUMP.search(code):
            raise ShaderError(f"{here[0]}:{here[1]}: a loop under #pragma unroll is not left by: {text.strip()}")
        if depth == 0 and i > start:
            if code.strip() != "}":
                raise ShaderError(f"{here[0]}:{here[1]}: write the closing brace of an unrolled loop on its own line")
            return i
    raise ShaderError(f"{place[0]}:{place[1]}: the loop under #pragma unroll has no closing brace")
