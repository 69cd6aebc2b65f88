"""Directives that generate tables from the code: a module's facts, its parameters, the scenes, the shell's help."""

import inspect
from typing import Any

import typer
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from aolab.loading import describe_scene, scene_names
from aolab.modules import MODULES, Module, known_buffers
from aolab.modules.parameters import describe
from aolab.shell.app import app as shell

HELP_COLUMNS = 84  # the width of a code block on a page, without scrolling


class Markdown(SphinxDirective):
    """A directive whose `text` is Markdown."""

    optional_arguments = 1

    def text(self) -> str:
        raise NotImplementedError

    @property
    def module(self) -> type[Module]:
        """The module that the argument names."""
        if self.arguments[0] not in MODULES:
            raise self.error(f"no module '{self.arguments[0]}'; known: {', '.join(MODULES)}")
        return MODULES[self.arguments[0]]

    def run(self) -> list[nodes.Node]:
        return self.parse_text_to_nodes(self.text())


class ModuleFacts(Markdown):
    """The facts of a module: docstring, paper, shader, outputs."""

    def text(self) -> str:
        module = self.module
        outputs = ", ".join(f"`{name}` ({format})" for name, format in module.outputs.items())
        rows = [
            ["Name", f"`{module.name}`"],
            ["Paper", module.paper],
            ["Shader", f"`glsl/{module.shader}`"],
            ["Output", outputs],
        ]
        return f"{inspect.getdoc(module)}\n\n" + _table(["", ""], rows)


class ParameterTable(Markdown):
    """The table of a module's parameters, from their declarations."""

    def text(self) -> str:
        keys = ("name", "type", "default", "range", "unit", "description")
        rows = []
        for about in (describe(self.module, name) for name in self.module.stated()):
            if about["with"]:
                about["description"] += f" With `{about['with']}`."
            about |= {key: f"`{about[key]}`" for key in ("name", "default")}
            about["range"] = (
                about["range"].replace(" ", "\u00a0").replace(",\u00a0", ", ")
            )  # no line break between a sign and its number
            rows.append([about[key] for key in keys])
        return _table([key.capitalize() for key in keys], rows)


class BufferTable(Markdown):
    """The table of buffers."""

    def text(self) -> str:
        rows = [
            [f"`{row.name}`", str(row.channels), row.format, row.unit, _background(row.background), row.kind, row.about]
            for row in known_buffers().values()
        ]
        return _table(["Name", "Channels", "Format", "Unit", "Background", "Kind", "Meaning"], rows)


def _background(value: float | None) -> str:
    return "environment" if value is None else f"{value:g}"


class ModuleTable(Markdown):
    """The table of all modules; the argument is the path to their pages."""

    def text(self) -> str:
        folder = "".join(self.arguments)
        rows = [[f"[`{name}`]({folder}{name}.md)", module.title, module.paper] for name, module in MODULES.items()]
        return _table(["Name", "Method", "Paper"], rows)


class SceneTable(Markdown):
    """The table of all scenes, with their parameters."""

    def text(self) -> str:
        rows = []
        for scene in map(describe_scene, scene_names()):
            parameters = ", ".join(f"`{name}={value}`" for name, value in scene.parameters.items())
            rows.append([f"`{scene.name}`", scene.summary, parameters])
        return _table(["Name", "Contents", "Parameters with defaults"], rows)


class ShellHelp(Markdown):
    """`aolab --help`, and the help of every command."""

    def text(self) -> str:
        group: Any = typer.main.get_command(shell())  # with the options for completion
        pages = [f"### {name}\n\n{_help_of(command, f'aolab {name}')}" for name, command in group.commands.items()]
        return "\n\n".join([_help(group, "aolab"), *pages])


def _help_of(command: Any, name: str) -> str:
    """The help of a command, and of its own commands, if it has some."""
    own = getattr(command, "commands", {})
    return "\n\n".join([_help(command, name), *(_help_of(one, f"{name} {word}") for word, one in own.items())])


def _help(command: Any, name: str) -> str:
    context = command.context_class(
        command, info_name=name, terminal_width=HELP_COLUMNS, max_content_width=HELP_COLUMNS
    )
    return f"```text\n{command.get_help(context)}\n```"


def _table(head: list[str], rows: list[list[str]]) -> str:
    cells = [[cell.replace("|", "\\|") for cell in row] for row in rows]
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, ["---"] * len(head), *cells])


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_directive("module-facts", ModuleFacts)
    app.add_directive("parameters", ParameterTable)
    app.add_directive("modules", ModuleTable)
    app.add_directive("buffers", BufferTable)
    app.add_directive("scenes", SceneTable)
    app.add_directive("shell-help", ShellHelp)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
