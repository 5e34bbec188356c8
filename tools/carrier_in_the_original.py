"""The scripted carrier of Armament Burden at play in ViZDoom, by what that engine says of its things.

    pip install vizdoom==1.3.2 hasard==0.2.0 numpy
    python carrier_in_the_original.py 1 300 [--hard]                                       # there: level, episodes
    hasard rollout ArmamentBurdenLevel1-v0 --policy carrier --rules released --maps auto --iwad auto --episodes 300 --json   # here

It walks to the nearest weapon that it may carry, and home with it, as `--policy carrier` does here (crates/envs/src/policies/carrier.rs). Where a
random policy earns nothing, it compares rewards for deliveries and costs of what is carried.
"""

import math
import os
import sys
import tempfile

import vizdoom

from published_engine import Published

WEAPONS = "Pistol Shotgun SuperShotgun Chaingun RocketLauncher PlasmaRifle BFG9000".split()
DECOYS = "BlurSphere Allmap Backpack RadSuit".split()
# Weapons that alone stay within the capacity: all under the soft constraint, five under the hard one.
LIGHT = {False: WEAPONS, True: WEAPONS[:5]}
GROUPS = [["TURN_LEFT", "TURN_RIGHT"], ["MOVE_FORWARD"], ["USE"], ["JUMP"]]
REACH, INTO_THE_STRIP, STRIP = 44.0, 60.0, 128.0
AHEAD, STRAIGHT, STANDSTILL, PATIENCE, STEPS_ASIDE = 40.0, 5.0, 3.0, 3, 8


def nearest(here, places):
    return min(places, key=lambda place: math.dist(here, place), default=None)


def clear(start, end, things):
    """Whether the straight way passes none of the things within reach."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    squared = max(dx * dx + dy * dy, 1.0)
    for x, y in things:
        along = min(max(((x - start[0]) * dx + (y - start[1]) * dy) / squared, 0.0), 1.0)
        if math.dist((x, y), (start[0] + along * dx, start[1] + along * dy)) <= REACH:
            return False
    return True


class Carrier:
    def __init__(self, light):
        self.light, self.last, self.stuck, self.aside, self.detours = light, (math.inf, math.inf), 0, 0, 0

    def goal(self, here, things, carrying):
        if carrying and here[0] > STRIP - INTO_THE_STRIP / 2:
            lying = [place for name, place in things if name in WEAPONS or name in DECOYS]
            doors = [(STRIP - INTO_THE_STRIP, 288.0 + 64.0 * tile) for tile in range(15)]
            return nearest(here, [door for door in doors if clear(here, door, lying)]) or nearest(here, doors)
        if carrying:
            return None
        light = [place for name, place in things if name in self.light]
        heavy = [place for name, place in things if (name in WEAPONS or name in DECOYS) and name not in self.light]
        alone = [one for i, one in enumerate(light) if all(i == j or math.dist(one, other) > REACH for j, other in enumerate(light))]
        return nearest(here, [one for one in alone if clear(here, one, heavy)]) or nearest(here, light)

    def act(self, here, angle, things, carrying):
        got_on = math.dist(here, self.last) > STANDSTILL
        self.last = here
        goal = self.goal(here, things, carrying)
        if goal is None:
            return [0, 0, 0, 0]
        off = (math.degrees(math.atan2(goal[1] - here[1], goal[0] - here[0])) - angle + 180) % 360 - 180
        turn = 0 if abs(off) <= STRAIGHT else 1 if off > 0 else 2
        forward = int(abs(off) < AHEAD)
        if forward:
            self.stuck = 0 if got_on else self.stuck + 1
        if self.stuck > PATIENCE:
            self.stuck, self.aside = 0, STEPS_ASIDE
            self.detours += 1
        if self.aside > 0:
            self.aside -= 1
            turn = (1 if self.detours % 2 == 0 else 2) if self.aside >= STEPS_ASIDE / 2 else 0
            return [turn, 1, 0, 1]
        return [turn, forward, 0, 0]


def main():
    level, episodes, hard = int(sys.argv[1]), int(sys.argv[2]), "--hard" in sys.argv
    os.chdir(tempfile.mkdtemp())
    world = Published("ArmamentBurden", level, hard, GROUPS, objects=True)
    for seed in range(1, episodes + 1):
        world.reset(seed)
        carrier, returned, cost, steps, over = Carrier(LIGHT[hard]), 0.0, 0.0, 0, False
        while not over:
            state = world.game.get_state()
            here = (world.variable("POSITION_X"), world.variable("POSITION_Y"))
            things = [(thing.name, (thing.position_x, thing.position_y)) for thing in state.objects]
            carrying = any(world.variable(f"WEAPON{slot}") > 0 for slot in range(2, 8))
            _, reward, charged, over = world.step(carrier.act(here, world.variable("ANGLE"), things, carrying))
            returned, cost, steps = returned + reward, cost + charged, steps + 1
        print(f"episode {seed}: return {returned:.3f}, cost {cost:.3f}, {steps} steps", flush=True)


if __name__ == "__main__":
    main()
