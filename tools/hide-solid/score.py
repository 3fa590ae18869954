"""A diagnosis beside the truth."""
PLACE = 0.03  # of the length of the rotor
DATA = ("sensor_gain", "sensor_sign", "sensor_swap", "sensor_position", "duplicate_channel")


def is_true(cause, effect, length):
    """Whether a cause of a result is this effect: kind, target, place within a width or 3 % of the length."""
    if cause["id"] != effect["id"] or cause["target"].replace("|", ",") != effect["target"]:
        return False
    found = {p["name"]: p["value"] for p in cause["parameters"]}
    return "z" not in effect or abs(found["z"] - effect["z"]) <= max(effect.get("width", 0), PLACE * length)


def is_found(finding, effect):
    sensors = {int(effect[key]) for key in ("sensor", "other") if key in effect}
    of_finding = set(finding["sensors"])
    return finding["id"] == effect["id"] and (of_finding == sensors if effect["id"] == "sensor_swap" else bool(of_finding & sensors))


def outcome(result, truth, allowed=()):
    """right, in set, missed, wrong; of two effects also `one of two`. `allowed`: names that are true beside the effects."""
    verdict, effects = result["verdict"], truth["effects"]
    named = [c for c in verdict["causes"] if c["id"] not in allowed]
    findings = [f for f in result["data_findings"] if f["id"] in DATA]
    physical, data = ([e for e in effects if (e["id"] in DATA) == of_data] for of_data in (False, True))
    matches = [any(is_true(c, e, truth["length"]) for c in named) for e in physical] + \
              [any(is_found(f, e) for f in findings) for e in data]
    if any(not any(is_true(c, e, truth["length"]) for e in physical) for c in named) or \
       any(not any(is_found(f, e) for e in data) for f in findings):
        return "wrong"
    if all(matches):  # of nothing hidden: nothing said
        return "right" if physical or verdict["kind"] == "adequate" or verdict["causes"] else "missed"
    if any(is_true(c, e, truth["length"]) for c in verdict["alternative_causes"] for e in physical):
        return "in set"
    return "one of two" if any(matches) else "missed"


def moduli(result, truth):
    """(name, value over truth - 1, inside its 95 % interval) of the model that the diagnosis ends with."""
    for p in result["gain"]["parameters"]:
        if p["name"] in truth["moduli"]:
            when = "before" if p["after"] is None else "after"  # nothing was added: there is no after
            value, exact, (lower, upper) = p[when], truth["moduli"][p["name"]], p[when + "_ci95"]
            yield p["name"], value / exact - 1, lower is not None and lower <= exact <= upper


def told(result):
    """What was said, in short."""
    def text(cause):
        value = cause["parameters"][0]["value"] if cause["parameters"] else None
        return f"{cause['id']} {cause['target']}".strip() + (f" {value:.3g}" if value is not None else "")

    verdict = result["verdict"]
    words = [verdict["kind"]] + [text(c) for c in verdict["causes"]]
    if verdict["alternative_causes"]:
        words.append("{" + "; ".join(text(c) for c in verdict["alternative_causes"]) + "}")
    words += [f"[{f['id']} {' '.join(map(str, f['sensors']))}]" for f in result["data_findings"]]
    return ", ".join(words)
