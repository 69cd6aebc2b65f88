"""Programs with OpenGL contexts of their own, in the same thread: both keep their pictures."""

import pytest

MINE = """
    import aolab, moderngl, numpy as np

    def own():
        return moderngl.create_context(standalone=True, backend="egl", libegl="libEGL.so.1", libgl="libGL.so.1")

    def value(texture):
        return np.frombuffer(texture.read(), np.uint8)[:4].tolist()
"""


def test_a_context_of_moderngl_beside_ours(python):
    """Its textures have the numbers that ours have: reading a frame once returned the user's texture."""
    done = python(MINE + """
    before = aolab.render("boxes", "ssao", size=(32, 24))
    theirs = own()
    textures = [theirs.texture((32, 24), 4, bytes([77]) * (32 * 24 * 4)) for _ in range(40)]
    right = before.image  # read now, while theirs is current
    assert 5 < np.nanmean(before["visibility"]) * 100 < 100
    after = aolab.render("boxes", "ssao", size=(32, 24))
    assert np.array_equal(after.image, right)
    target = theirs.framebuffer([textures[0]])
    target.clear(1.0, 0.0, 0.0, 1.0)
    assert value(textures[0]) == [255, 0, 0, 255] and value(textures[1]) == [77] * 4
    del before, after
    aolab.render("boxes", "none", size=(16, 16))  # frees what nobody keeps, and nothing of theirs
    assert value(textures[2]) == [77] * 4
    assert np.array_equal(aolab.render("boxes", "ssao", size=(32, 24)).image, right)
    """)  # fmt: skip
    assert done.returncode == 0, done.stderr


def test_a_context_of_moderngl_before_ours(python):
    done = python(MINE + """
    theirs = own()
    texture = theirs.texture((8, 8), 4, bytes([9]) * 256)
    picture = aolab.render("boxes", "none", size=(32, 24)).image
    assert value(texture) == [9] * 4
    assert picture.std() > 1
    """)  # fmt: skip
    assert done.returncode == 0, done.stderr


def test_a_renderer_of_pyrender_beside_ours(python):
    """Its `delete` ends EGL's display, which once ended our context."""
    pytest.importorskip("pyrender", reason="pyrender is an extra", exc_type=Exception)
    done = python("""
    import aolab, numpy as np, pyrender, trimesh

    scene = pyrender.Scene()
    scene.add(pyrender.Mesh.from_trimesh(trimesh.creation.box()))
    scene.add(pyrender.PerspectiveCamera(1), pose=trimesh.transformations.translation_matrix((0, 0, 3)))
    first = aolab.render(scene, "ssao", size=(32, 24))
    renderer = pyrender.OffscreenRenderer(32, 24)
    color, depth = renderer.render(scene)
    assert abs(depth.max() - 2.5) < 0.1
    second = aolab.render(scene, "ssao", size=(32, 24))
    assert np.array_equal(first.image, second.image)
    assert abs(renderer.render(scene)[1].max() - 2.5) < 0.1
    renderer.delete()
    assert np.array_equal(aolab.render(scene, "ssao", size=(32, 24)).image, first.image)
    assert np.array_equal(first["albedo"], second["albedo"])  # read late, of a frame made before
    """, PYOPENGL_PLATFORM="egl")  # fmt: skip
    assert done.returncode == 0, done.stderr
