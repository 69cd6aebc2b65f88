"""Parameters as text: `KEY=VALUE`, and `NAME?KEY=VALUE&KEY=VALUE` for scenes and modules."""

from urllib.parse import unquote

from .errors import ParameterError


def pair(text: str) -> tuple[str, str]:
    """The key and the value of `KEY=VALUE`; a hyphen in the key becomes an underscore. Raises `ParameterError`."""
    key, equals, value = text.partition("=")
    if not equals or not key.strip():
        raise ParameterError(f"'{text}' is not key=value")
    return key.strip().replace("-", "_"), value.strip()


def query(text: str) -> tuple[str, dict[str, str]]:
    """The name and the parameters of `NAME?KEY=VALUE&...`. Raises `ParameterError`."""
    name, _, rest = text.strip().partition("?")
    return name, parameters(text, rest)


def parameters(source: str, text: str) -> dict[str, str]:
    """The parameters of `KEY=VALUE&KEY=VALUE`, with %-escapes resolved; `source` is named in errors.

    Raises `ParameterError` for a part without "=" and for a key that is given twice.
    """
    values: dict[str, str] = {}
    for part in text.split("&") if text else []:
        try:
            key, value = map(unquote, pair(part))
        except ParameterError as error:
            raise ParameterError(f"'{source}': {error}; write NAME?KEY=VALUE&KEY=VALUE") from None
        if key in values:
            raise ParameterError(f"'{source}': parameter '{key}' is given twice")
        values[key] = value
    return values
