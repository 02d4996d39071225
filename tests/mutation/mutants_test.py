#!/usr/bin/env python3
"""The one-line mistakes that are made of a source file."""

import unittest

from mutants import mutants_of

SOURCE = """#include "swiftlet/a.hpp"  // a < b
namespace swiftlet {

// a + b
double limited(double value, const Limits& limits) {
  const double most = limits.most - 2.0;
  if (value > most) return most;
  log("value + most", value);
  state_.value = std::clamp(value, -most, most);
  return rotation.transpose() * turned(value, most)[0];
}

}  // namespace swiftlet
"""


class Mutants(unittest.TestCase):
    def setUp(self):
        self.mutants = mutants_of("a.cpp", SOURCE)

    def made_of(self, line):
        return {mutant.after.strip() for mutant in self.mutants if mutant.line == line}

    def test_neither_comments_nor_texts_nor_includes_are_changed(self):
        self.assertEqual({mutant.line for mutant in self.mutants}, {6, 7, 8, 9, 10})
        self.assertEqual(self.made_of(8), {";"})

    def test_each_kind_of_mistake_is_made(self):
        self.assertEqual(self.made_of(6), {"const double most = limits.most + 2.0;", "const double most = limits.most - 3.0;",
                                           "const double most = limits.most;"})
        self.assertEqual(self.made_of(7), {"if (value >= most) return most;", "if (!(value > most)) return most;"})
        self.assertEqual(self.made_of(9), {";", "state_.value = (value);", "state_.value = std::clamp(value, most, most);"})
        self.assertIn("return rotation * turned(value, most)[0];", self.made_of(10))
        self.assertIn("return rotation.transpose() * turned(most, value)[0];", self.made_of(10))
        self.assertIn("return rotation.transpose() * turned(value, most)[1];", self.made_of(10))
        self.assertIn("return rotation.transpose() / turned(value, most)[0];", self.made_of(10))

    def test_a_mutant_differs_in_one_line(self):
        for mutant in self.mutants:
            self.assertEqual(mutant.before, SOURCE.splitlines()[mutant.line - 1])
            self.assertNotEqual(mutant.before, mutant.after)


if __name__ == "__main__":
    unittest.main()
