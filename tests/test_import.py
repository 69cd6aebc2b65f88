"""`import aolab` is light: heavy libraries are loaded on first use, and OpenGL by the first render."""

import pytest

import aolab

HEAVY = ["moderngl", "glcontext", "trimesh", "scipy", "numpy", "PIL", "pydantic", "embreex", "pandas", "matplotlib"]
HEAVY += ["numpy.random", "numpy.polynomial", "numpy.ma", "logging"]  # which others import by the way


def loaded(python, code: str) -> set[str]:
    done = python(f"import sys; {code}; print(*(name for name in {HEAVY} if name in sys.modules))")
    assert done.returncode == 0, done.stderr
    return set(done.stdout.split())


def test_the_package_alone_loads_nothing_heavy(python):
    assert loaded(python, "import aolab; dir(aolab); aolab.__version__") == set()


def test_its_names_load_no_file_formats_no_pictures_and_no_truth(python):
    names = "aolab.Lab, aolab.render, aolab.load, aolab.SSAO, aolab.Scene, aolab.Camera"
    assert loaded(python, f"import aolab; {names}") <= {"moderngl", "numpy", "pydantic"}


def test_naming_everything_makes_no_context(python):
    done = python(
        """
        import aolab
        for name in aolab.__all__:
            getattr(aolab, name)
        from aolab.gl import context
        print(context._state.context)
        """
    )
    assert (done.returncode, done.stdout) == (0, "None\n"), done.stderr


def test_the_shells_help_loads_nothing_heavy(python):
    run = "import sys; sys.argv = ['aolab']\nfrom aolab.shell.cli import main\ntry: main()\nexcept SystemExit: pass\n"
    done = python(run + f"print('LOADED', *(name for name in {HEAVY} if name in sys.modules))")
    assert done.stdout.splitlines()[-1] == "LOADED", done.stdout


@pytest.mark.parametrize("name", aolab.__all__)  # pyright: ignore[reportAttributeAccessIssue]
def test_every_public_name_is_there(name):
    assert getattr(aolab, name) is not None
    assert name in dir(aolab)


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="Labb"):
        aolab.Labb  # noqa: B018  # pyright: ignore[reportAttributeAccessIssue]
