"""SSDO, figure 13: beside a path tracer."""

from itertools import pairwise

from ...gl.texture import Size
from ...modules import Module, Unoccluded
from ...pipeline.frame import Frame
from ...scene.scene import Scene
from ...truth import reference
from ..figure import Figure, Need, figure
from ..pixels import rmse
from .stage import BOUNCE, DIRECTIONAL, OCCLUSION, PRINTED, drawn, stage

STEPS: dict[str, Module] = {
    "none": Unoccluded(),
    "SSAO": OCCLUSION,
    "SSDO": DIRECTIONAL,
    "SSDO + 1 bounce": BOUNCE,
    "SSDO + 1 bounce, peeled layers": BOUNCE.replace(occluders="layers"),
}
PRINTED_STEPS: dict[str, Module] = {
    "SSAO, 1 step": OCCLUSION.replace(steps=1),
    "SSDO as printed": PRINTED.replace(bounces=0),
    "SSDO + 1 bounce as printed": PRINTED,
}
OTHERS: dict[str, Module] = {"SSDO + 1 bounce of patches, 8 steps": BOUNCE.replace(senders="patches")}


def fig13(size: Size = (400, 225), rays: int = 256) -> Figure:
    """The stage beside its truth: direct and ambient light and one bounce of both, all within the radius.

    Numbers: the RMSE of the radiance over pixels with a surface. The materials are of a middle grey; the JSON file has
    the errors among white ones too, where occlusion without a bounce is far too dark.
    """
    frames, truth = _beside_truth(stage(albedo=0.4), size, rays)
    errors = _errors(frames, truth)
    white = _errors(*_beside_truth(stage(), size, rays))
    needs = []
    for chain in (STEPS, {"none": STEPS["none"], **PRINTED_STEPS}):
        for before, after in pairwise(chain):
            needs.append(Need(f"the error of {after} over that of {before}", errors[after] / errors[before], below=1))
    for after, most in (("SSDO + 1 bounce", 0.6), ("SSDO + 1 bounce, peeled layers", 0.3)):
        needs.append(Need(f"the error of {after} over that of none", errors[after] / errors["none"], below=most))
    claim = "Against one-bounce rays the error falls from none to SSAO, to SSDO, to SSDO with a bounce"
    pictures = [(f"{name}: RMSE {errors[name]:.4f}", frame.image) for name, frame in frames.items()]
    pictures.append((f"rays, {rays} a pixel", truth.image))
    return figure("SSDO, Fig. 13", claim, needs, {"rmse": errors, "rmse_among_white": white, "rays": rays}, pictures, 5)


def _beside_truth(scene: Scene, size: Size, rays: int) -> tuple[dict[str, Frame], Frame]:
    frames = {name: drawn(scene, module, size) for name, module in (STEPS | PRINTED_STEPS | OTHERS).items()}
    return frames, reference(scene, size=size, like=BOUNCE, rays=rays, buffers=("radiance", "image"))


def _errors(frames: dict[str, Frame], truth: Frame) -> dict[str, float]:
    return {name: rmse(frame["radiance"], truth["radiance"], truth.mask) for name, frame in frames.items()}
