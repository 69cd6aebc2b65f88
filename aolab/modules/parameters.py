"""Parameters, stated once: validation, command line, uniforms, sliders and docs derive from the statement."""

import json
import re
import warnings
from collections.abc import Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, get_args, get_origin
from weakref import WeakKeyDictionary

from pydantic import BaseModel, ConfigDict, Field, PydanticUserError, ValidationError, model_serializer

from ..errors import ParameterError, suggestion
from ..gl.source import Constant
from ..pictures import html

AUTO = "auto"
# words for one meaning, in papers, engines and here: an error suggests the word that the module has
SYNONYMS = (
    ("bounces", "indirect", "bounce", "gi"),
    ("directions", "samples", "rays", "taps"),
    ("power", "strength", "intensity", "contrast"),
    ("filter", "blur", "denoise"),
    ("scale", "half", "half_resolution", "downsample"),
    ("radius", "distance", "range", "max_distance"),
)


def parameter(
    default: Any,
    description: str,
    *,
    ge: float | None = None,
    gt: float | None = None,
    le: float | None = None,
    unit: str = "",
) -> Any:
    """A parameter of a module: default, one sentence, inclusive (`ge`, `le`) or exclusive (`gt`) range, unit."""
    return Field(default, description=description, ge=ge, gt=gt, le=le, json_schema_extra={"unit": unit})


class _Declared(type(BaseModel)):
    """The metaclass of parameters: a mistake in the declaration of a class is a `ParameterError`."""

    def __new__(cls, name: str, bases: tuple[type, ...], namespace: dict[str, Any], **options: Any) -> type:
        try:
            with warnings.catch_warnings():  # a subclass refuses such names by an error
                warnings.filterwarnings("ignore", ".*shadows an attribute", UserWarning)
                # validators of the package's own classes are built at the first use: 0.07 s less at the start
                deferred = namespace.get("__module__", "").startswith("aolab.")  # `type(...)` names none
                return super().__new__(cls, name, bases, namespace, **{"defer_build": deferred, **options})
        except PydanticUserError as error:
            raise ParameterError(_declaration(name, namespace, error)) from None


def _declaration(name: str, namespace: Mapping[str, Any], error: PydanticUserError) -> str:
    """The message about a wrong declaration."""
    first = str(error).partition("\n")[0]
    fields = [key for key, value in namespace.items() if not key.startswith("_") and re.search(rf"\b{key}\b", first)]
    if error.code == "model-field-missing-annotation" and fields:
        value = namespace[fields[0]]
        kind = type(getattr(value, "default", value)).__name__
        return f"class {name}: parameter '{fields[0]}' has no type; write {fields[0]}: {kind} = ..."
    return f"class {name}: {first}"


class Parameters(BaseModel, metaclass=_Declared):
    """Values with names, types, ranges and units. Raises `ParameterError` for an unknown name or a wrong value."""

    model_config = ConfigDict(frozen=True, extra="forbid", validate_default=True, allow_inf_nan=False)

    if not TYPE_CHECKING:  # type checkers see the fields as arguments, which do not change

        def __setattr__(self, name: str, value: object) -> None:
            if name in type(self).stated():
                what = label(type(self))
                raise ParameterError(f"{what}: {name} cannot be changed; write module.replace({name}={value!r:.80})")
            super().__setattr__(name, value)

        def __init__(self, **values: object) -> None:
            values = self.prepared(values)
            try:
                super().__init__(**values)
            except ValidationError as error:
                raise ParameterError(_explain(type(self), error, values)) from None
            except PydanticUserError as error:
                raise ParameterError(_declaration(type(self).__name__, {}, error)) from None

    @classmethod
    def read(cls, values: Mapping[str, Any]) -> dict[str, Any]:
        """`values` with each text replaced by the JSON value that it spells: a number, true or false.

        The brackets of a tuple may be left out: 0.1,0.2,0.3.
        """

        def value(name: str, given: Any) -> Any:
            if not isinstance(given, str):
                return given
            owner = cls.stated().get(name)
            annotation = str if owner is None else owner.model_fields[name].annotation
            if annotation is not str:
                listed = get_origin(annotation) is tuple and not given.startswith("[")
                with suppress(ValueError, RecursionError):  # no JSON; too many digits; brackets within brackets
                    return json.loads(f"[{given}]" if listed else given)
            return given

        return {name: value(name, given) for name, given in values.items()}

    @classmethod
    def prepared(cls, values: dict[str, Any]) -> dict[str, Any]:
        """The values as they are validated; a subclass may complete them."""
        return values

    @classmethod
    def label(cls) -> str:
        """The name that users know the class by."""
        return str(getattr(cls, "name", "") or cls.__name__)

    @classmethod
    def stated(cls) -> dict[str, "type[Parameters]"]:
        """{parameter: the class that states it}, in the order of their statements."""
        return dict.fromkeys(cls.model_fields, cls)

    def values(self) -> dict[str, Any]:
        """{name: value} of all parameters.

        The package calls `values`, not `model_dump`: pydantic turns a KeyboardInterrupt in a serializer into a
        `ValueError`, and Ctrl-C is lost.
        """
        return {name: getattr(self, name) for name in type(self).model_fields}

    @model_serializer
    def _serialized(self) -> dict[str, Any]:
        return self.values()

    def numbers(self) -> dict[str, Constant]:
        """The values that a shader may take, as uniforms or as constants: words never reach a shader."""
        own = {name: getattr(self, name) for name in type(self).model_fields}
        return {name: value for name, value in own.items() if isinstance(value, (bool, int, float))}

    def vectors(self) -> dict[str, tuple[float, ...]]:
        """The values that a shader may take as a uniform vec2, vec3 or vec4: tuples of as many numbers."""
        own = {name: getattr(self, name) for name in type(self).model_fields}
        tuples = {name: value for name, value in own.items() if isinstance(value, tuple) and 2 <= len(value) <= 4}
        return {name: value for name, value in tuples.items() if all(isinstance(one, (int, float)) for one in value)}

    def replace(self, **changes: object) -> Self:
        """The same with some values changed, validated again."""
        return type(self)(**{**{name: getattr(self, name) for name in type(self).model_fields}, **changes})

    def _repr_html_(self) -> str:
        """A table of the parameters, in the order of `own_first`."""
        cls, values, rows = type(self), self.values(), []
        for about in (describe(cls, name) for name in own_first(cls)):
            within = ", ".join(part for part in (about["type"], about["range"], about["with"]) if part)
            rows.append((about["name"], values.get(about["name"], "-"), within, about["unit"], about["description"]))
        title = str(getattr(cls, "title", ""))
        return html.table(("parameter", "value", "range", "unit", ""), rows, f"{label(cls)}: {title}".rstrip(": "))


class Choice(Parameters):
    """One alternative on an `axis` on which modules choose by name ("occluders", "filter"), with its parameters."""

    axis: ClassVar[str] = ""
    name: ClassVar[str] = ""

    @classmethod
    def label(cls) -> str:
        return f"{cls.axis}='{cls.name}'"


def own_first(parameters: type[Parameters]) -> list[str]:
    """The names of the parameters: those of the class, of its nearest base class, and so on; then those of choices."""
    bases = [base for base in parameters.__mro__ if issubclass(base, Parameters)]
    names = [name for base in bases for name in base.__annotations__ if name in parameters.model_fields]
    return list(dict.fromkeys([*names, *parameters.stated()]))


def label(parameters: type[Parameters]) -> str:
    """The name that users know the class by."""
    return parameters.label()


def _explain(parameters: type[Parameters], error: ValidationError, values: dict[str, object]) -> str:
    messages = {}
    for item in error.errors():
        name = str(item["loc"][0]) if item["loc"] else ""
        if item["type"] == "extra_forbidden":
            messages[name] = unknown(parameters, name)
        elif name:
            described = describe(parameters, name)
            # a default of the wrong type or out of its range is none of the given values
            given = (
                "has no value" if item["type"] == "missing" else f"= {values.get(name, item['input'])!r} is not valid"
            )
            messages[name] = (
                f"{label(parameters)}: {name} {given}: {described['type']}"
                + (f", {described['range']}" if described["range"] else "")
                + (f", in {described['unit']}" if described["unit"] else "")
            )
        else:
            messages[name] = f"{label(parameters)}: {item['msg']}"
    return "; ".join(messages.values())


def is_word(parameters: type[Parameters], name: str) -> bool:
    """Whether all values of a parameter are words; words never reach a shader."""
    annotation = parameters.model_fields[name].annotation
    return get_origin(annotation) is Literal and all(isinstance(value, str) for value in get_args(annotation))


def words(parameters: type[Parameters], name: str) -> list[str]:
    """The words that are values of a parameter: all of them, or those besides numbers, as auto."""
    about = _properties(parameters)[name]
    branches = [about, *about.get("anyOf", [])]
    values = [value for branch in branches for value in (*branch.get("enum", ()), branch.get("const"))]
    return [value for value in values if isinstance(value, str)]


_schemas: WeakKeyDictionary[type, dict[str, Any]] = WeakKeyDictionary()  # pydantic takes milliseconds for each


def _properties(parameters: type[Parameters]) -> dict[str, Any]:
    """The JSON schema of each parameter."""
    if parameters not in _schemas:
        _schemas[parameters] = parameters.model_json_schema()["properties"]
    return _schemas[parameters]


def unknown(parameters: type[Parameters], name: str) -> str:
    """The error message for a name that is no parameter."""
    known = parameters.stated()
    meant = [word for words in SYNONYMS if name in words for word in words if word in known]
    return f"{label(parameters)} has no parameter '{name}'{suggestion((*meant, name)[0], known)}"


def describe(parameters: type[Parameters], name: str) -> dict[str, str]:
    """One parameter as text: name, type, default, range, unit, description; `with`, the choice that it belongs to."""
    if name not in parameters.model_fields:
        parameters = parameters.stated()[name]
    properties = _properties(parameters)[name]
    branches = [properties, *properties.get("anyOf", [])]
    bounds: dict[str, Any] = {}
    for branch in branches:
        bounds |= {key: branch[key] for key in _BOUNDS if key in branch}
    return {
        "name": name,
        "type": _type_name(parameters.model_fields[name].annotation),
        "default": str(parameters.model_fields[name].default),
        "range": ", ".join(f"{_BOUNDS[key]} {bounds[key]:g}" for key in _BOUNDS if key in bounds),
        "unit": properties.get("unit", ""),
        "description": properties.get("description", ""),
        "with": label(parameters) if issubclass(parameters, Choice) else "",
    }


_BOUNDS = {"minimum": "≥", "exclusiveMinimum": ">", "maximum": "≤", "exclusiveMaximum": "<"}


def _type_name(annotation: Any) -> str:
    if get_origin(annotation) is Literal:
        return " or ".join(str(value) for value in get_args(annotation))
    if args := [a for a in get_args(annotation) if a is not type(None)]:
        if hasattr(annotation, "__metadata__"):
            return _type_name(args[0])
        if get_origin(annotation) is tuple:
            return f"({', '.join(_type_name(a) for a in args)})"
        return " or ".join(_type_name(a) for a in args)
    return getattr(annotation, "__name__", str(annotation))
