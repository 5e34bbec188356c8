"""Wrappers of single environments: costs in sight, costs in the reward, the safety state of Sauté RL, and depth that can be filmed."""

from hasard_rs.wrappers.cost import CostPenalty, CostWrapper
from hasard_rs.wrappers.drawable import Drawable
from hasard_rs.wrappers.saute import Saute

__all__ = ["CostPenalty", "CostWrapper", "Drawable", "Saute"]
