#!/usr/bin/env python3
"""Measures the steps per second of the environments of reinforcement learning.

usage: bench.py BUILD [--json]

Each environment is stepped by random actions for two seconds, ends and new episodes included; the best of three parts counts.
"of CPU time": steps per second of processor time of all threads, which other work on the machine hardly changes.
"""
import json
import os
import sys
import time

PERIOD_S = 0.02
MEASURED_S = 2.0
# Speed-up against the wall clock, published by gym-pybullet-drones (docs/python.md): without vision, on an i7-8850H, physics at
# 240 Hz and PID control at 48 Hz for each drone.
PUBLISHED = {1: 15.5, 10: 2.1}
PUBLISHED_PHYSICS_HZ, PUBLISHED_CONTROL_HZ = 240, 48


def measure(level, count, threads):
    from swiftlet.gym import HoverVectorEnv

    envs = HoverVectorEnv(count, level=level, threads=threads, action_period_s=PERIOD_S)
    envs.reset(seed=1)
    envs.action_space.seed(1)
    actions = [envs.action_space.sample() for _ in range(8)]
    if level != "actuators" and level != "trajectory":
        for action in actions:  # thrust near the weight, so that episodes last
            action[:, 3] = 9.81
    best = best_of_cpu = 0.0
    for _ in range(3):
        steps, started, cpu_before = 0, time.perf_counter(), time.process_time()
        while (took := time.perf_counter() - started) < MEASURED_S / 3:
            envs.step(actions[steps % len(actions)])
            steps += 1
        best = max(best, steps * count / took)
        best_of_cpu = max(best_of_cpu, steps * count / (time.process_time() - cpu_before))
    return best, best_of_cpu


def main():
    sys.path.insert(0, os.path.join(sys.argv[1], "python"))
    from swiftlet import load_simulation

    physics_hz = 1.0 / load_simulation("default").step_s
    cores = os.cpu_count()
    rows = []
    for level, count, threads in (("actuators", 1, 1), ("actuators", 10, 1), ("actuators", 256, 1), ("actuators", 256, cores),
                                  ("rates", 256, 1), ("attitude", 256, 1), ("trajectory", 256, 1)):
        speed, speed_of_cpu = measure(level, count, threads)
        rows.append({"level": level, "vehicles": count, "threads": threads, "steps_per_s": speed, "steps_per_cpu_s": speed_of_cpu,
                     "physics_steps_per_s": speed * PERIOD_S * physics_hz, "real_time_factor": speed * PERIOD_S / count})
    if "--json" in sys.argv:
        print(json.dumps(rows, indent=2))
        return
    print(f"{'level':<12}{'vehicles':>9}{'threads':>9}{'steps/s':>12}{'of CPU time':>13}{'physics steps/s':>17}{'times real time':>17}")
    for row in rows:
        print(f"{row['level']:<12}{row['vehicles']:>9}{row['threads']:>9}{row['steps_per_s']:>12,.0f}{row['steps_per_cpu_s']:>13,.0f}"
              f"{row['physics_steps_per_s']:>17,.0f}{row['real_time_factor']:>17,.1f}")
    print(f"\nA step is {1e3 * PERIOD_S:.0f} ms: {PERIOD_S * physics_hz:.0f} steps of the physics at {physics_hz:.0f} Hz.")
    for count, factor in PUBLISHED.items():
        print(f"gym-pybullet-drones, published, {count} drone{'s' if count > 1 else ''}: {factor} times real time, "
              f"{factor * count * PUBLISHED_CONTROL_HZ:,.0f} steps/s, {factor * count * PUBLISHED_PHYSICS_HZ:,.0f} physics steps/s")


main()
