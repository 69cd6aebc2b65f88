"""The Python blocks of the docs that are no cells run, page by page in a fresh folder, at a small size."""

import re
from pathlib import Path
from shutil import copy

import pytest

import aolab
from aolab import paths

DOCS = Path(__file__).parents[1] / "docs"
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
# names that a page's blocks suppose
BEFORE = {
    "notebooks.md": 'frame = aolab.render("boxes", "ssao", size=(320, 240))',
    "your_own_module.md": "from pathlib import Path",
}
# smaller texts in place of those of the blocks
SMALLER = {
    "notebooks.md": {"size=(480, 270)": "size=(48, 27)"},
    "files.md": {'"model.glb"': '"knot.glb"', "rays=256": "rays=2", "texels=1024": "texels=32"},
    "sweeps.md": {
        '["boxes", "colonnade"]': '["boxes"]',
        '["ssao", "ssdo", "s3ho"]': '["ssao", "s3ho"]',
        "directions=[4, 8, 16], seed=range(4)": "directions=[2, 4], seed=range(2), size=(48, 27), rays=8",
        'folder="out/sweep",': 'folder="out/sweep", images=True,',  # the last line of the second block needs images
    },
}
ELSEWHERE = {
    "errors_in_shaders.md": "tests/modules/test_shader_mistakes.py",
    "truth.md": "tests/truth/test_mitsuba.py",  # and a class that is a part of aolab/modules/hao.py
}
CLUSTER = "SLURMCluster"  # no machine here has SLURM
BLOCKS = {
    page.relative_to(DOCS).as_posix(): [
        block for block in BLOCK.findall(page.read_text(encoding="utf-8")) if CLUSTER not in block
    ]
    for page in sorted(DOCS.rglob("*.md"))
    if "_build" not in page.parts
}
BLOCKS = {page: blocks for page, blocks in BLOCKS.items() if blocks and page not in ELSEWHERE}


@pytest.mark.slow
@pytest.mark.parametrize("page", BLOCKS)
def test_the_blocks_of_a_page_run_one_after_another(page, gl, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    copy(paths.scenes() / "knot.glb", tmp_path)
    copy(paths.glsl() / "ssao.frag", tmp_path / "ball.frag")
    code = "\n".join([BEFORE.get(page, ""), *BLOCKS[page]])
    for text, smaller in SMALLER.get(page, {}).items():
        assert text in code, f"docs/{page} has no '{text}'"
        code = code.replace(text, smaller)
    exec(compile(code, page, "exec"), {"aolab": aolab, "__name__": page})


def test_blocks_that_run_elsewhere_have_a_test():
    assert {"notebooks.md", "sweeps.md", "files.md"} <= BLOCKS.keys()
    for path in ELSEWHERE.values():
        assert (DOCS.parent / path).is_file(), path
