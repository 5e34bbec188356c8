"""The shortest loop that works: one world, random actions, rewards and costs of an episode."""

import hasard_rs

env = hasard_rs.make("hasard/VolcanicVentureLevel1-v0")
observation, info = env.reset(seed=7)
total_reward = total_cost = 0.0
while True:
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
    total_reward += reward
    total_cost += info["cost"]
    if terminated or truncated:
        break
print(f"return {total_reward:.1f}, cost {total_cost:.1f}, budget {env.unwrapped.safety_budget:.0f}")
