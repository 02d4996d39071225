#!/usr/bin/env python3
"""The tools of the manual read Markdown, commands and settings as the manual's authors mean them."""

import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "docs" / "site")]
import configuration  # noqa: E402
import run_commands  # noqa: E402
import stage  # noqa: E402
from manual_text import ManualError, anchors, fences, links, map_links  # noqa: E402

PAGE = """# A page
Text with `[no](link)` and [a link](other.md#part).
- an item
  that goes on

```sh exit 1: it fails
swiftlet fly  # [no](link)
```
## Second: a *part*
"""


class Text(unittest.TestCase):
    def test_fences_have_language_words_and_text(self):
        (fence,) = fences(PAGE, "page")
        self.assertEqual((fence.language, fence.words, fence.line), ("sh", "exit 1: it fails", 6))
        self.assertEqual(fence.text, "swiftlet fly  # [no](link)\n")

    def test_a_fence_without_end_is_refused(self):
        with self.assertRaisesRegex(ManualError, "page:2: this fence does not end"):
            fences("text\n```sh\nswiftlet\n", "page")

    def test_links_are_those_outside_of_code(self):
        self.assertEqual(links(PAGE, "page"), [("other.md#part", 2)])

    def test_changed_links_leave_the_rest(self):
        changed = map_links(PAGE, "page", lambda target, line: "x")
        self.assertEqual(changed, PAGE.replace("other.md#part", "x"))

    def test_a_link_may_have_code_as_its_text(self):
        self.assertEqual(links("[`a(b)`](c.md) and ![picture](d.png)", "page"), [("c.md", 1), ("d.png", 1)])

    def test_anchors_are_those_of_the_headings(self):
        self.assertEqual(anchors(PAGE, "page"), {"a-page", "second-a-part"})

    def test_anchors_exclude_those_that_readers_of_markdown_number_or_join_differently(self):
        self.assertEqual(anchors("# One\n# One\n# Two - three\n", "page"), {"one"})


class Site(unittest.TestCase):
    def test_lists_and_tables_get_the_empty_line_before_them(self):
        self.assertEqual(stage.loosen("Text:\n- one\n  more\n- two\n\nText\n| a |\n|---|\n| b |", "page"),
                         "Text:\n\n- one\n  more\n- two\n\nText\n\n| a |\n|---|\n| b |")

    def test_words_for_the_test_are_left_out(self):
        self.assertEqual(stage.loosen("```sh skip: slow\na\n- b\n```", "page"), "```sh\na\n- b\n```")

    def check(self, text):
        stage.check({"docs/page.md": text, "idl/README.md": "# Topics\n"}, {"docs/page.md": "", "idl/README.md": ""})

    def test_links_to_files_folders_and_headings_are_accepted(self):
        self.check("# Here\n[a](#here) [b](../idl/README.md#topics) [c](../idl#topics) [d](../config) [e](https://x.org/#y)")

    def test_broken_links_are_refused(self):
        for target in ("no.md", "../idl/README.md#nothing", "#nothing", "../../elsewhere", "../dev#part"):
            with self.subTest(target), self.assertRaisesRegex(ManualError, r"docs/page\.md:2: "):
                self.check(f"# Here\n[a]({target})")

    def test_fences_must_name_their_language(self):
        with self.assertRaisesRegex(ManualError, r"docs/page\.md:1: a fence in ''"):
            self.check("```\ntext\n```")


class Commands(unittest.TestCase):
    def block(self, words, language="sh"):
        (fence,) = fences(f"```{language} {words}\ntext\n```", "page")
        return run_commands.Block(fence, "page")

    def test_words_say_what_happens(self):
        self.assertEqual(self.block("skip: slow").skip, "slow")
        self.assertEqual(self.block("exit 2: refused").exit_code, 2)
        self.assertTrue(self.block("realtime").realtime)
        self.assertEqual(self.block("file: hop.yaml", "yaml").file, "hop.yaml")
        self.assertFalse(self.block("file: run.sh").is_commands)
        self.assertTrue(self.block("printed", "text").prints)

    def test_other_words_are_refused(self):
        for words in ("skip:", "skip", "exit 1", "exit 3: no", "file: ../x", "fast"):
            with self.subTest(words), self.assertRaisesRegex(ManualError, "page:1: "):
                self.block(words)

    def test_commands_are_split_as_by_the_shell(self):
        text = ("swiftlet-plant & swiftlet-mocap &  # both\nswiftlet arm && swiftlet goto 1 0 -1\n"
                "source <(swiftlet completion bash)\nswiftlet fly --json | jq .x > out\nA=1 swiftlet man \\\n  fly\n")
        found = [words for words in run_commands.commands_of(text) if words[0].startswith("swiftlet")]
        self.assertEqual(found, [["swiftlet-plant"], ["swiftlet-mocap"], ["swiftlet", "arm"], ["swiftlet", "goto", "1", "0", "-1"],
                                 ["swiftlet", "completion", "bash"], ["swiftlet", "fly", "--json"], ["swiftlet", "man", "fly"]])

    def test_unknown_commands_and_options_are_refused(self):
        helps = run_commands.Help(pathlib.Path("bin"), pathlib.Path("."))
        helps.texts = {("swiftlet",): "Subcommands:\n  fly   Fly\n", ("swiftlet", "fly"): "Options:\n  -o,--out TEXT  file\n"}

        def check(text):
            (fence,) = fences(f"```sh\n{text}\n```", "page")
            helps.check(run_commands.Block(fence, "page"))

        check("swiftlet fly square --out=x -o y -1 # --no")
        with self.assertRaisesRegex(ManualError, "swiftlet flyy': not a command"):
            check("swiftlet flyy square")
        with self.assertRaisesRegex(ManualError, "'swiftlet fly' has no option --ou"):
            check("swiftlet fly --ou x")


class Settings(unittest.TestCase):
    FILE = "# The file.\n\nname: a  # its name\n# RPT.\nposition:\n  x: {omega_n: 2.0, zeta: 1}\n  limit_m: 3  # far\n"

    def test_numbers_are_replaced_where_they_stand(self):
        for key, old, new in (("position.x.omega_n", "omega_n: 2.0", "omega_n: 9"), ("position.x.zeta", "zeta: 1", "zeta: 9"),
                              ("position.limit_m", "limit_m: 3", "limit_m: 9")):
            with self.subTest(key):
                self.assertEqual(configuration.with_number(self.FILE, key, "9"), self.FILE.replace(old, new))

    def test_what_is_no_number_is_left_alone(self):
        for key in ("name", "position.x", "position.y.omega_n", "zeta"):
            with self.subTest(key):
                self.assertIsNone(configuration.with_number(self.FILE, key, "9"))

    def test_comments_belong_to_the_key_before_or_below_them(self):
        about = configuration.comments(self.FILE)
        self.assertEqual((about["name"], about["position"], about["position.limit_m"]), ("its name", "RPT.", "far"))
        self.assertEqual(configuration.meaning("position.x.omega_n", about), "RPT.")


if __name__ == "__main__":
    unittest.main()
