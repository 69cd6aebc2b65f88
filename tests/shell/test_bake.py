"""`aolab bake`: a file with occlusion; mistakes are told before the work."""

import aolab as package


def test_a_model_is_baked_into_a_file(aolab, tmp_path):
    done = aolab("bake", "cornell", "-o", "room.glb", "--rays", "16", "--texels", "16", "--radius", "0.3")
    assert done.code == 0, done.err
    assert done.out.startswith("room.glb: ")
    assert "vertices" in done.out
    scene = package.load(tmp_path / "room.glb")
    assert all(instance.mesh.visibility is not None for instance in scene.instances)
    assert min(instance.mesh.visibility.min() for instance in scene.instances) < 0.8


def test_mistakes_are_told_in_one_line_before_the_work(aolab, tmp_path):
    for arguments, words in (
        (("cornell", "-o", "none/room.glb"), "the folder none does not exist"),
        (("cornel", "-o", "room.glb"), "cornell"),
        (("cornell", "-o", "room.glb", "--rays", "3"), "rays = 3 is not an even"),
        (("cornell", "-o", "room.obj", "--rays", "2", "--texels", "1"), "written as .glb"),
    ):
        done = aolab("bake", *arguments)
        assert done.code != 0
        assert words in done.err
        assert len(done.err.strip().splitlines()) == 1
    assert not list(tmp_path.iterdir())
