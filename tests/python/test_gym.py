"""The environments of reinforcement learning, without Gymnasium and with it if it is installed."""
import copy
import pickle
import unittest

import numpy as np

import swiftlet
from swiftlet.gym import USES_GYMNASIUM, HoverEnv, HoverVectorEnv

LEVELS = ("actuators", "rates", "attitude", "trajectory")


def towards_target(observations):
    return np.concatenate([2.0 * observations[:, :3], np.zeros((len(observations), 1))], axis=1)


class Single(unittest.TestCase):
    def test_has_the_spaces_of_its_level(self):
        for level in LEVELS:
            env = HoverEnv(level=level)
            observation, info = env.reset(seed=1)
            self.assertEqual((observation.shape, info), ((22,), {}))
            self.assertIn(observation, env.observation_space)
            self.assertEqual(env.action_space.shape, (4,))
            env.action_space.seed(1)
            action = env.action_space.sample()
            self.assertIn(action, env.action_space)
            observation, reward, terminated, truncated, info = env.step(action)
            self.assertIsInstance(reward, float)
            self.assertEqual((terminated, truncated, info), (False, False, {}))

    def test_same_seed_same_episode(self):
        runs = []
        for seed in (1, 1, 2):
            env = HoverEnv(level="rates")
            observation, _ = env.reset(seed=seed)
            env.action_space.seed(3)
            runs.append([observation] + [env.step(env.action_space.sample())[0] for _ in range(5)])
        np.testing.assert_array_equal(runs[0], runs[1])
        self.assertFalse(np.array_equal(runs[0], runs[2]))

    def test_ends_by_termination_or_time(self):
        env = HoverEnv(level="actuators")
        env.reset(seed=1)
        ends = (False, False)
        while ends == (False, False):
            observation, reward, *ends, _ = env.step(np.zeros(4))
            ends = tuple(ends)
        self.assertEqual(ends, (True, False))
        self.assertGreater(np.linalg.norm(observation[:3]), 1.0, "the last observation of the fall")
        with self.assertRaises(RuntimeError):
            env.step(np.zeros(4))
        self.assertLess(np.linalg.norm(env.reset()[0][:3]), 0.5)
        env = HoverEnv(level="trajectory", episode_s=1.0)
        observation, _ = env.reset(seed=1)
        for step in range(50):
            observation, reward, terminated, truncated, _ = env.step(towards_target(observation[np.newaxis])[0])
        self.assertEqual((terminated, truncated), (False, True))
        self.assertGreater(reward, 0.0)

    def test_next_episodes_follow_from_the_seed(self):
        starts = []
        for _ in range(2):
            env = HoverEnv(episode_s=0.02)
            starts.append([env.reset(seed=4)[0]])
            env.step(np.full(4, 0.4))
            starts[-1] += [env.reset()[0], env.reset()[0]]
        np.testing.assert_array_equal(starts[0], starts[1])
        self.assertEqual(len(np.unique(np.array(starts[0])[:, 0])), 3)


class Vector(unittest.TestCase):
    def test_hovers_by_velocities(self):
        envs = HoverVectorEnv(16, level="trajectory", dispersion="kaylion")
        observations, _ = envs.reset(seed=1)
        total = np.zeros(16)
        for _ in range(500):
            observations, rewards, terminated, truncated, infos = envs.step(towards_target(observations))
            total += rewards
            self.assertFalse(terminated.any())
        self.assertTrue(truncated.all())
        self.assertTrue(infos["_final_obs"].all())
        self.assertLess(np.linalg.norm(infos["final_obs"][:, :3], axis=1).max(), 0.1)
        self.assertGreater(np.linalg.norm(observations[:, :3], axis=1).max(), 0.1, "the next episodes have begun")
        self.assertGreater(total.min(), 7.0)

    def test_does_not_depend_on_threads_and_equals_single_ones(self):
        flown = []
        for threads in (1, 3):
            envs = HoverVectorEnv(5, level="rates", threads=threads)
            rows = [envs.reset(seed=10)[0]]
            envs.action_space.seed(1)
            rows += [envs.step(envs.action_space.sample())[0] for _ in range(30)]
            flown.append(np.array(rows))
        np.testing.assert_array_equal(flown[0], flown[1])
        for i in range(5):
            np.testing.assert_array_equal(flown[0][0, i], HoverEnv(level="rates").reset(seed=10 + i)[0])

    def test_refuses_wrong_arguments(self):
        envs = HoverVectorEnv(2)
        with self.assertRaises(RuntimeError):
            envs.step(np.zeros((2, 4)))
        envs.reset(seed=1)
        with self.assertRaisesRegex(swiftlet.InputError, r"shape \(2, 4\)"):
            envs.step(np.zeros((3, 4)))
        with self.assertRaisesRegex(swiftlet.InputError, "environment 1 .* finite"):
            envs.step([[0, 0, 0, 0], [0, np.nan, 0, 0]])
        with self.assertRaisesRegex(swiftlet.InputError, "^threads is 5000, must be from 1 to 1024"):
            HoverVectorEnv(2, threads=5000)
        with self.assertRaisesRegex(swiftlet.InputError, "^action_period_s is 0.0205"):
            HoverVectorEnv(1, action_period_s=0.0205)
        vehicle = swiftlet.load_vehicle("kaylion")
        vehicle.battery.open_circuit_voltage_v = []
        with self.assertRaisesRegex(swiftlet.InputError, "battery"):
            HoverVectorEnv(1, vehicle=vehicle)
        with self.assertRaisesRegex(swiftlet.InputError, "^level is"):
            HoverVectorEnv(1, level="wings")
        with self.assertRaisesRegex(swiftlet.InputError, "at least 0"):
            envs.reset(seed=-1)

    def test_a_copy_goes_on_and_a_pickle_begins_anew(self):
        for env in (HoverEnv(level="rates"), HoverVectorEnv(3, level="rates", autoreset_mode="NextStep", episode_s=0.1)):
            actions = np.ones(env.action_space.shape)
            env.reset(seed=7)
            env.step(actions)
            copied, pickled = copy.deepcopy(env), pickle.loads(pickle.dumps(env))
            with self.assertRaises(RuntimeError):
                pickled.step(actions)
            for _ in range(5):
                np.testing.assert_equal(copied.step(actions), env.step(actions))
            np.testing.assert_array_equal(pickled.reset(seed=7)[0], env.reset(seed=7)[0])
            np.testing.assert_equal(pickled.step(actions), env.step(actions))

    def test_all_autoreset_modes_fly_the_same_episodes(self):
        """Episodes of 3 steps, and what each mode says where one ends."""
        flown = {}
        for mode in ("SameStep", "NextStep", "Disabled"):
            envs = HoverVectorEnv(2, level="rates", episode_s=0.06, autoreset_mode=mode)
            value = envs.metadata["autoreset_mode"]
            self.assertEqual(getattr(value, "value", value), mode)
            rows = [envs.reset(seed=1)[0]]
            while len(rows) < 8:
                observations, rewards, terminated, truncated, infos = envs.step(np.zeros((2, 4)))
                rows.append(observations)
                if not truncated.all():
                    continue
                if mode == "SameStep":
                    rows[-1:] = [infos["final_obs"], observations]
                elif mode == "NextStep":
                    observations, rewards, terminated, truncated, infos = envs.step(np.full((2, 4), np.pi))
                    self.assertEqual((rewards.any(), terminated.any(), truncated.any(), infos), (False, False, False, {}))
                    rows.append(observations)
                else:
                    with self.assertRaisesRegex(RuntimeError, "an episode has ended"):
                        envs.step(np.zeros((2, 4)))
                    first, _ = envs.reset(options={"reset_mask": np.array([True, False])})
                    np.testing.assert_array_equal(first[1], observations[1], "not chosen: its last observation")
                    rows.append(envs.reset(options={"reset_mask": np.array([False, True])})[0])
            flown[mode] = np.array(rows)
        np.testing.assert_array_equal(flown["SameStep"], flown["NextStep"])
        np.testing.assert_array_equal(flown["SameStep"], flown["Disabled"])
        with self.assertRaisesRegex(swiftlet.InputError, "^autoreset_mode is Never, must be"):
            HoverVectorEnv(1, autoreset_mode="Never")
        with self.assertRaisesRegex(swiftlet.InputError, "reset_mask must be bool"):
            envs.reset(options={"reset_mask": [1, 0]})

    @unittest.skipUnless(USES_GYMNASIUM, "Gymnasium is not installed")
    def test_passes_the_checker_of_gymnasium(self):
        from gymnasium.utils.env_checker import check_env

        for level in LEVELS:
            check_env(HoverEnv(level=level), skip_render_check=True)
