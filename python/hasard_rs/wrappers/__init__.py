"""Wrappers of single environments: costs in sight, costs in the reward, and the safety state of Sauté RL."""

from hasard_rs.wrappers.cost import CostPenalty, CostWrapper
from hasard_rs.wrappers.saute import Saute

__all__ = ["CostPenalty", "CostWrapper", "Saute"]
