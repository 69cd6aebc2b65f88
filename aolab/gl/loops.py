"""The length of a shader's loops."""

from ..errors import ParameterError

# Mesa's software drivers end the loops of a shader after so many steps in all, without an error
LOOP_STEPS = 65535


def check_loops(steps: int, what: str) -> None:
    """Raise `ParameterError` if a shader's loops have more steps in all than software drivers run."""
    if steps >= LOOP_STEPS:
        raise ParameterError(
            f"{what}: {steps} steps of a shader's loops; software drivers end them after {LOOP_STEPS}. "
            "Use fewer samples or lights"
        )
