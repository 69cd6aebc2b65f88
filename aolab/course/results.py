"""The result of a check, as text, and as JSON in the form of Gradescope's results.json."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

COMPILES = "compiles"


@dataclass(frozen=True)
class Checked:
    """One check: its points, and a sentence about the measured numbers."""

    step: str
    kind: str
    points: float
    passed: bool
    message: str

    @property
    def score(self) -> float:
        return self.points if self.passed else 0.0


@dataclass(frozen=True)
class StepResult:
    """A step with its checks. `hint` names the mistake that the picture shows, or is empty, as `mistake`."""

    name: str
    title: str
    checks: tuple[Checked, ...]
    begun: bool = True
    mistake: str = ""
    hint: str = ""

    @property
    def passed(self) -> bool:
        return all(check.passed for check in self.checks)

    @property
    def score(self) -> float:
        return sum(check.score for check in self.checks)

    @property
    def points(self) -> float:
        return sum(check.points for check in self.checks)


@dataclass(frozen=True)
class Result:
    """All steps of an exercise. `error` is the reason why nothing could be checked, or empty."""

    exercise: str
    title: str
    steps: tuple[StepResult, ...] = ()
    error: str = ""
    notes: tuple[str, ...] = field(default=())

    @property
    def score(self) -> float:
        return sum(step.score for step in self.steps)

    @property
    def points(self) -> float:
        return sum(step.points for step in self.steps)

    @property
    def passed(self) -> bool:
        return not self.error and all(step.passed for step in self.steps)

    def __getitem__(self, step: str) -> StepResult:
        return next(one for one in self.steps if one.name == step)

    def to_dict(self) -> dict[str, Any]:
        """The form of Gradescope's results.json: `score`, `output`, and `tests`, one for each check."""
        tests = [
            {
                "name": f"{step.name}: {check.kind}" if step.name != check.kind else check.kind,
                "number": f"{number}.{place}",
                "score": check.score,
                "max_score": check.points,
                "status": "passed" if check.passed else "failed",
                "output": check.message,
            }
            for number, step in enumerate(self.steps)
            for place, check in enumerate(step.checks, 1)
        ]
        hints = {step.name: {"mistake": step.mistake, "hint": step.hint} for step in self.steps if step.hint}
        return {
            "score": self.score,
            "output": str(self),
            "tests": tests,
            "extra_data": {
                "exercise": self.exercise,
                "max_score": self.points,
                "hints": hints,
                "error": self.error,
                "notes": list(self.notes),
            },
        }

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> "Result":
        """The result of `dataclasses.asdict`."""
        steps = [
            StepResult(**{**step, "checks": tuple(Checked(**check) for check in step["checks"])})
            for step in values["steps"]
        ]
        return cls(**{**values, "steps": tuple(steps), "notes": tuple(values["notes"])})

    def __str__(self) -> str:
        lines = [f"{self.title}: {self.score:g} of {self.points:g} points"]
        for step in self.steps:
            state = "" if step.begun else "  (not begun)"
            lines.append(f"{step.score:3g} of {step.points:g}  {step.name}: {step.title}{state}")
            if step.begun:
                lines += [f"           {'ok  ' if one.passed else 'no  '}{one.message}" for one in step.checks]
            if step.hint:
                lines.append(f"           hint: {step.hint}")
        lines += [f"error: {self.error}"] if self.error else []
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        from ..pictures import html

        return f'<pre style="overflow-x: auto; white-space: pre-wrap">{html.escape(str(self))}</pre>'
