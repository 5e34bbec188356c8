//! The file that `hasard new` writes: it plays at once, and says what may be changed.

/// The text for a name.
#[must_use]
pub fn template(name: &str) -> String {
    TEMPLATE.replace("NAME", name)
}

const TEMPLATE: &str = r##"# A task of your own. Play it:   hasard play FILE      Look at it:  hasard check FILE -o map.png
# Train an agent:                hasard train FILE     All fields: docs/guide/own_task.md

[scenario]
name = "NAME"                     # ids are made of it: NAME-v0, or NAMELevel1-v0 where there are [levels.2] and so on
title = "Collect vials, keep off the lava"
tics = 2100                       # length of an episode; 35 tics are a second
budget = 25                       # cost that an episode may have
actions = [["TURN_LEFT", "TURN_RIGHT"], ["MOVE_FORWARD"], ["JUMP"]]

[map]
tile = 64                         # side of a tile; the agent is 32 wide and steps 24 high
ascii = """
################
#......#.......#
#......#...~~..#
#..@.......~~..#
#......#.......#
####.#####..####
#......#.......#
#..~~..#...o...#
#..~~..........#
#......#.......#
################"""

[map.legend]                      # '#' is rock, '.' ground, '@' the start, if nothing else is said
"." = { floor = 0, ceiling = 128, light = 192 }
"~" = { like = ".", floor = -8, floor_texture = "LAVA1", zone = "lava", damage = { points = 1, every = 4 } }
"o" = { like = ".", thing = "TechLamp" }

[player]
health = 200

[[spawn]]                         # what appears, where and when
name = "vials"
kind = "HealthBonus"
count = 12                        # at the start
respawn = 0                       # tics after which what was taken comes back elsewhere
in = "free"                       # anywhere that does not hurt; or a zone, or [west, south, east, north]

[[when]]                          # what counts: an event, and what it brings
event = "pickup"
of = "vials"
reward = 1.0
count = "vials"                   # a statistic of the episode

[[when]]
event = "damage"
by = "lava"
cost.lava = 1.0                   # for each health point
count = "burns"

[hard]                            # what `--hard` changes
end_on = ["lava"]                 # a cost that ends the episode
"##;
