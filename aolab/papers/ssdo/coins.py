"""Coins on a table, for SSDO's figures 9 to 12: their contacts, and a card that lights them by its bounce."""

import numpy as np
from scipy.ndimage import binary_dilation

from ...loading import load
from ...pipeline.frame import Frame
from ...scene.environment import Environment
from ...scene.lights import SpotLight
from ...scene.mesh import Material
from ...scene.scene import Instance, Scene
from ...scene.shapes import block, placed
from ..pixels import world_positions

CARD_X = -6.5  # the card's side that faces the coins, cm


def table(frame: Frame) -> np.ndarray:
    """(H, W) bool: the upper side of the table."""
    return frame.mask & (np.abs(world_positions(frame)[..., 1]) < 0.01)


def contacts(frame: Frame) -> np.ndarray:
    """(H, W) bool: the table's pixels that touch a pixel of a coin or of the marble."""
    things = frame.mask & (world_positions(frame)[..., 1] > 0.01) & (world_positions(frame)[..., 0] > CARD_X + 0.5)
    return table(frame) & binary_dilation(things, np.ones((3, 3)))


def under_a_card() -> Scene:
    """The coins in the dark, beside a pale card in the light of a spot: all of their light is the card's bounce."""
    coins = load("coins")
    card = Instance(block((0.4, 9.0, 14.0), Material((0.8, 0.75, 0.7)), "card"), placed(CARD_X - 0.2, -0.01, 0.5))
    spot = SpotLight((5.0, 9.0, 0.5), (CARD_X - 5.0, -4.5, 0.0), (400.0, 380.0, 350.0), inner=18, outer=20)
    return coins.replace(instances=(*coins.instances, card), lights=(spot,), environment=Environment.constant(0.0))
