"""The reference of the configuration keys.

The keys and values are those that the programs read from the files in config: `swiftlet report` lists them. The allowed
values are those that the programs name when they refuse a value: each number is replaced by a very small and a very large
one. The meanings are the comments in the files. Keys of missions are those of config/missions/mission.schema.json, which
a test compares with the reader.
"""

import json
import pathlib
import re
import subprocess
import tempfile

from manual_text import ManualError, plain, table

EXTREMES = ("-1000000000000000", "1000000000000000")
_KEY_LINE = re.compile(r"^(\s*)(?:- )?(\w+):(.*)$")
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


class Programs:
    """Runs the built `swiftlet` in a folder of its own."""

    def __init__(self, bin_folder, root, folder):
        self.swiftlet, self.root, self.folder = bin_folder / "swiftlet", root, pathlib.Path(folder)

    def run(self, *words):
        try:
            return subprocess.run([str(self.swiftlet), *map(str, words)], cwd=self.folder, capture_output=True, text=True,
                                  timeout=120, check=False, env={"SWIFTLET_CONFIG_DIR": str(self.root / "config"),
                                                                 "PATH": "/usr/bin:/bin"})
        except OSError as error:
            raise ManualError(f"{self.swiftlet}: {error.strerror}: build the programs first, './dev build programs'") from error

    def record(self):
        """A flight record, to which files of settings can be copied."""
        result = self.run("sim", "fly", "square", "--record", "record")
        if result.returncode != 0:
            raise ManualError(f"swiftlet sim fly square: exit code {result.returncode}: {result.stderr.strip()}")
        return self.folder / "record"

    def settings(self, record, section, file):
        """Key and value of each setting of a file, as `swiftlet report` reads it."""
        (record / f"{section}.yaml").write_text(file.read_text())
        result = self.run("report", record, "--json")
        if result.returncode != 0:
            raise ManualError(f"swiftlet report: {file}: {result.stderr.strip()}")
        flattened = json.loads(result.stdout)["flights"][0]["settings"]
        return {key[len(section) + 1:]: value for key, value in flattened.items() if key.startswith(section + ".")}


def comments(text):
    """Path of each key in block style -> the comment behind it or, without one, those right above it."""
    found, above, path = {}, [], []
    for line in text.splitlines():
        whole = line.lstrip().startswith("#")
        code, _, comment = ("", "", line.lstrip()[1:]) if whole else line.partition(" #")
        if not code.strip():
            above = [*above, comment.strip()] if whole else []
            continue
        key = _KEY_LINE.match(code)
        if key:
            indent = len(key.group(1))
            path = [(at, name) for at, name in path if at < indent] + [(indent, key.group(2))]
            found[".".join(name for _, name in path)] = comment.strip() or " ".join(above)
        above = []
    return found


def with_number(text, key, value):
    """The file with another number, at a key such as position.x.omega_n; None if the text has it in another form."""
    lines, path = text.splitlines(), []
    names = key.split(".")
    for i, line in enumerate(lines):
        found = _KEY_LINE.match(line)
        if not found or line.lstrip().startswith("#"):
            continue
        indent = len(found.group(1))
        path = [(at, name) for at, name in path if at < indent] + [(indent, found.group(2))]
        here = [name for _, name in path]
        if here != names[: len(here)]:
            continue
        rest = names[len(here):]
        pattern = rf"^(\s*{here[-1]}:\s*)" if not rest else rf"^(\s*{here[-1]}:\s*\{{(?:.*[{{,]\s*)?{rest[0]}:\s*)"
        if len(rest) > 1:
            continue
        changed, count = re.subn(rf"{pattern}{_NUMBER}(?=\s*([,}}#]|$))", rf"\g<1>{value}", line)
        if count == 1:
            return "\n".join(lines[:i] + [changed] + lines[i + 1 :]) + "\n"
    return None


def allowed(programs, file, key, refuse):
    """What the program says a number must be; `any number` if it takes both extremes; empty if it is no number."""
    rules = []
    for extreme in EXTREMES:
        text = with_number(file.read_text(), key, extreme)
        if text is None:
            return ""
        changed = programs.folder / "changed.yaml"
        changed.write_text(text)
        result = refuse(changed)
        # `.value` is how a quantity's number is named in the file but not in the message
        name = re.escape(re.sub(r"\.value$", "", key))
        found = re.search(rf"changed\.yaml:\d+: {name}(?:\.value)?: is [^,]*, must be (.*)$", result.stderr, re.MULTILINE)
        if found:
            rule = re.sub(r"^a finite number (?:of )?", "", found.group(1))
            rules += [rule] if rule not in rules else []
    return "; ".join(rules) or "any number"


def meaning(key, about):
    """The comment of a key; of a key inside braces also that of the keys around it."""
    if key in about:
        return about[key]
    names = key.split(".")
    around = (".".join(names[:count]) for count in range(len(names) - 1, 0, -1))
    return next((about[name] for name in around if about.get(name)), "")


def section(programs, record, kind, folder, names, refuse):
    """A table of the keys of files of one kind, with a column for each file."""
    files = {name: programs.root / "config" / folder / f"{name}.yaml" for name in names}
    values = {name: programs.settings(record, kind, file) for name, file in files.items()}
    about = {}
    for file in files.values():
        for key, text in comments(file.read_text()).items():
            about[key] = about.get(key) or text
    keys = list(dict.fromkeys(key for settings in values.values() for key in settings))
    rows = []
    for key in keys:
        first = next(name for name in names if key in values[name])
        rows.append((f"`{key}`", *(plain(values[name].get(key, "")) for name in names),
                     allowed(programs, files[first], key, refuse), plain(meaning(key, about))))
    return table(["key", *(f"`{name}`" for name in names), "allowed", "meaning"], rows)


def vehicles(programs, record, name):
    """The parameters of a vehicle file, a row each: value, unit, source."""
    file = programs.root / "config/vehicles" / f"{name}.yaml"
    settings = programs.settings(record, "vehicle", file)
    rows = []

    def refuse(changed):
        return programs.run("mission", "check", "no_mission", "--vehicle", changed)

    for key, value in settings.items():
        parameter, _, part = key.rpartition(".")
        if part in ("unit", "source"):
            continue
        if part != "value":
            parameter = key
        rows.append((f"`{parameter}`", plain(value), plain(settings.get(f"{parameter}.unit", "")),
                     allowed(programs, file, key, refuse)))
    return table(["key", f"`{name}`", "unit", "allowed"], rows)


def fault_kinds(root):
    file = root / "config/simulation/faults_example.yaml"
    lines = re.findall(r"^#   (\w.*|  +\S.*)$", file.read_text().split("All kinds", 1)[-1], re.MULTILINE)
    if len(lines) < 10:
        raise ManualError(f"{file.relative_to(root)}: its list of fault kinds below 'All kinds' was not found")
    return "```text\n" + "\n".join(lines) + "\n```\n"


def dispersion_parameters(programs):
    file = programs.folder / "unknown.yaml"
    file.write_text("parameters:\n  unknown: {distribution: uniform, min: 0, max: 1, unit: nominal, source: none}\n")
    message = programs.run("sim", "fly", "no_mission", "--dispersion", file).stderr
    found = re.search(r"must be one of (.*)$", message, re.MULTILINE)
    if not found:
        raise ManualError(f"swiftlet sim fly --dispersion did not list its parameters but said: {message.strip()}")
    return "".join(f"- `{name}`\n" for name in found.group(1).split(", "))


def type_of(schema, definitions):
    """A JSON schema as words."""
    schema = {**definitions.get(schema.get("$ref", "").rpartition("/")[2], {}), **schema}
    if "anyOf" in schema:
        return " or ".join(type_of(option, definitions) for option in schema["anyOf"])
    if "const" in schema:
        return f"`{json.dumps(schema['const']).strip(chr(34))}`"
    if "enum" in schema:
        return ", ".join(f"`{choice}`" for choice in schema["enum"])
    kind = schema.get("type", "")
    limits = [f"{word} {schema[name]:g}" for name, word in (("exclusiveMinimum", "above"), ("minimum", "at least"),
                                                           ("maximum", "at most")) if name in schema]
    if kind == "array":
        count = " to ".join(str(schema[name]) for name in ("minItems", "maxItems") if name in schema)
        return f"list of {' to '.join(dict.fromkeys(count.split(' to ')))} of: {type_of(schema['items'], definitions)}"
    return ", ".join(filter(None, [{"object": "map", "string": "text"}.get(kind, kind), " and ".join(limits)]))


def description_of(schema, definitions):
    reference = definitions.get(schema.get("$ref", "").rpartition("/")[2], {})
    return schema.get("description", reference.get("description", ""))


def missions(root):
    schema = json.loads((root / "config/missions/mission.schema.json").read_text())
    definitions = schema["definitions"]

    def keys(properties, required):
        return table(["key", "required", "value", "meaning"],
                     [(f"`{key}`", "yes" if key in required else "", type_of(value, definitions),
                       plain(description_of(value, definitions))) for key, value in properties.items() if key != "kind"])

    out = [keys(schema["properties"], schema["required"])]
    for name in ("limits", "geofence"):
        part = schema["properties"][name]
        out.append(f"\n### {name}\n\n" + keys(part["properties"], part.get("required", [])))
    for kind in definitions["item"]["properties"]["kind"]["enum"]:
        part = definitions[kind]
        out.append(f"\n### kind: {kind}\n\n{plain(part.get('description', ''))}\n\n"
                   + keys(part["properties"], part.get("required", [])))
    return "".join(out)


def page(root, bin_folder):
    with tempfile.TemporaryDirectory() as folder:
        programs = Programs(bin_folder, root, folder)
        record = programs.record()
        control = section(programs, record, "control", "control", ["motor_lag", "paper"],
                          lambda changed: programs.run("mission", "check", "no_mission", "--control", changed))
        simulation = section(programs, record, "simulation", "simulation", ["default", "optitrack", "ideal"],
                             lambda changed: programs.run("sim", "fly", "no_mission", "--simulation", changed))
        vehicle = vehicles(programs, record, "kaylion")
        dispersion = dispersion_parameters(programs)
    return (
        "# Configuration keys\n\n"
        "This page is generated from the files in `config` and from what the programs answer to values that they refuse. "
        "Every key is required, unless the text says otherwise. A key that is unknown, missing, repeated or outside its limits "
        "is refused with file, line, key, value and limit.\n\n"
        "`--vehicle`, `--control`, `--simulation` and `--dispersion` take the path of a file or the name of one in the "
        "configuration. The configuration is searched in `$SWIFTLET_CONFIG_DIR`, then in `/etc/swiftlet` if it is "
        "installed by a package, then in `../share/swiftlet/config` and in `../../config` beside the program.\n\n"
        f"## Control settings\n\nFiles in `config/control`.\n\n{control}\n"
        f"## Simulation\n\nFiles in `config/simulation`.\n\n{simulation}\n"
        "### Faults\n\nThe optional list `faults`. Each entry has `kind`, `at_s`, `for_s` and the keys of its kind. "
        f"[How to use it](../simulation.md#faults).\n\n{fault_kinds(root)}\n"
        "## Vehicle\n\nFiles in `config/vehicles`. A parameter is a map of `value`, `unit` and `source`; the reader accepts only "
        "the unit of the table. In `rotor`, the factors may be replaced by `thrust_coefficient`, `torque_coefficient`, `radius` "
        "and `air_density`. The optional section `uncertainty` is described in "
        f"[Identify a vehicle](../identification.md#in-the-vehicle-file).\n\n{vehicle}\n"
        "## Dispersion\n\nFiles in `config/dispersion`: the optional `name`, and `parameters`. Each parameter has `distribution` "
        "(`uniform`, `log_uniform` or `normal`), `min`, `max`, with `normal` also `mean` and `sigma`, `unit` (its own, or "
        f"`nominal` for multiples of the nominal value) and `source`. The parameters:\n\n{dispersion}\n"
        f"## Mission\n\nFiles in `config/missions`. [Fly a mission](../missions.md) explains them.\n\n{missions(root)}\n"
        "## Fleet\n\nFiles in `config/fleets`. [Fly a swarm](../swarms.md) explains them.\n\n"
        "## Room\n\nFiles in `config/rooms`. [Swap the motion capture](../swap-mocap.md#the-room-file) explains them.\n"
    )
