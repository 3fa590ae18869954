"""Draws of what was identified, and stochastic rotors of ROSS from them."""
import numpy as np

from .program import RotidError
from .ross import built, compare, exported, parts_of, round_section


def draws(result, count, seed=None):
    """Parameters as a host of `rotid identify` knows them: name -> [count], from the normal distribution with the identified values,
    standard deviations and correlation. RotidError where a standard deviation is not known, or a parameter is at a bound: then the
    distribution is another one. Draws of moduli that are not above zero, and of any parameter beyond its bounds, are drawn anew."""
    if not count >= 1:
        raise RotidError([f"the number of draws is {count}, expected at least 1"])
    parameters = result["parameters"]
    for p in parameters:
        if p["std"] is None or not np.isfinite(p["std"]):
            raise RotidError([f"{p['name']} has no standard deviation, expected parameters that the data determine"])
        if p["at_bound"]:
            raise RotidError([f"{p['name']} ended at a bound, expected a parameter inside its bounds"])
    std = np.array([p["std"] for p in parameters])
    mean = np.array([p["value"] for p in parameters])
    correlation = np.atleast_2d(np.asarray(result["correlation"], dtype=float))
    if correlation.shape != (len(std),) * 2 or not np.isfinite(correlation).all():
        raise RotidError(["the correlation of the parameters is not known"])
    values, vectors = np.linalg.eigh((correlation + correlation.T) / 2)
    root = vectors * np.sqrt(np.maximum(values, 0))
    generator = np.random.default_rng(seed)
    positive = np.array([p["name"].endswith((".E", ".G")) for p in parameters])
    lower, upper = (np.array([none if p.get(key) is None else p[key] for p in parameters]) for key, none in (("lower", -np.inf), ("upper", np.inf)))
    drawn, tries = np.empty((0, len(std))), 0
    while len(drawn) < count:
        tries += 1
        if tries > 100:
            raise RotidError(["most draws have a modulus that is not above zero or a parameter beyond its bounds, expected standard deviations far "
                              "below the values and the bounds"])
        more = mean + generator.standard_normal((count, len(std))) @ root.T * std
        inside = (more[:, positive] > 0).all(axis=1) & ((more >= lower) & (more <= upper)).all(axis=1)
        drawn = np.vstack((drawn, more[inside]))
    return {p["name"]: drawn[:count, i] for i, p in enumerate(parameters)}


def stochastic(deck, drawn, program=None, **options):
    """An ST_Rotor of ROSS with a rotor for each draw of {"group.E": [count], "group.G": [count]}: EI of the elements of that group is
    proportional to E, kGS to k G, and k depends on G where the material is a stack of sheets (docs/method.md). RotidError for other
    parameters, and for groups with layers, whose sections depend on the moduli of one group in another way."""
    import ross
    from ross.stochastic import ST_Material, ST_Rotor, ST_ShaftElement

    model = exported(deck, False, program, options)
    scale, count = scales(model, drawn)
    shaft, disks, springs, rest = parts_of(model, {group for group, _ in scale})
    rotor = built(model, shaft, disks, springs, rest)
    compare(model, rotor)
    elements = []
    for element, (length, outer, inner, e, g, rho, force, group, segment) in zip(rotor.shaft_elements, shaft):
        young, shear = scale.get((group["name"], "E")), scale.get((group["name"], "G"))
        if young is None and shear is None:
            elements.append(element)
            continue
        young = np.ones(count) if young is None else young
        bending, resistance = young, shear_scale(group["material"], segment, young, shear)
        area, inertia = np.pi / 4 * (outer**2 - inner**2), np.pi / 64 * (outer**4 - inner**4)
        sections = [round_section(outer, e * inertia * a, element.kappa * g * area * b, rho * area, rho * inertia) for a, b in zip(bending, resistance)]
        if not all(sections):
            raise RotidError([f"{deck}: ROSS has no material for some draws of {group['name']}: G is too large for E"])
        material = ST_Material(name=element.material.name, rho=rho, E=np.array([s[2] for s in sections]), G_s=np.array([s[3] for s in sections]))
        elements.append(ST_ShaftElement(L=length, idl=inner, odl=outer, material=material, n=element.n, axial_force=force, is_random=["material"]))
    return ST_Rotor(elements, rotor.disk_elements, rotor.bearing_elements)


def scales(model, drawn):
    """Draws over the values of the model, by group and modulus, and how many."""
    deck, groups = model["deck"], {group["name"]: group for group in model["geometry"]["groups"]}
    layered = {group.get("layer_of") for group in groups.values()} - {None}
    at = {one: p["value"] for p in model["out"]["parameters"] for one in p["name"].split("=")}  # of a shared unknown each of its groups
    drawn = {one: values for name, values in drawn.items() for one in name.split("=")}
    count = {len(values) for values in drawn.values()}
    if len(count) != 1:
        raise RotidError(["the parameters have differing numbers of draws, expected the same"])
    scale = {}
    for name, values in drawn.items():
        group, _, modulus = name.rpartition(".")
        if group not in groups or modulus not in ("E", "G"):
            raise RotidError([f"{deck}: {name} is no modulus of a group of the axis, expected such as core.E and core.G"])
        if group in layered or groups[group].get("layer_of"):
            raise RotidError([f"{deck}: {name}: a section with layers depends on it in another way than in proportion"])
        material = groups[group]["material"]
        material.setdefault("g_follows", is_isotropic(material) and f"{group}.G" not in at)  # as stated: e_pa becomes the fitted one
        key = "e_pa" if modulus == "E" else "g_pa"
        value = at.get(name, material[key])
        if modulus == "E" and material["g_follows"]:
            material["g_pa"] *= value / material["e_pa"]
        material[key] = value
        values = np.asarray(values, dtype=float)
        if not (values > 0).all():
            raise RotidError([f"{deck}: {name} has draws that are not above zero"])
        scale[group, modulus] = values / value
    return scale, count.pop()


def is_isotropic(material):
    return abs(material["g_pa"] * 2 * (1 + material["nu"]) / material["e_pa"] - 1) < 1e-9 and not material.get("sheet_e_pa")


def shear_scale(material, segment, young, shear):
    """kGS over that of the model. Where E alone was drawn of an isotropic material, G goes with it."""
    if shear is None:
        return young if material["g_follows"] else np.ones_like(young)
    if not material.get("sheet_e_pa"):
        return shear
    if segment.get("height_m"):
        n, d0, d1 = 10, 12, 11
    else:
        ratio = segment["inner_m"] / (segment["stiff_outer_m"] or segment["outer_m"])
        a, b = (1 + ratio**2) ** 2, ratio**2
        n, d0, d1 = 6 * a, 7 * a + 20 * b, 6 * a + 12 * b
    x = material["nu"] * material["g_pa"] / material["sheet_e_pa"]  # k = n/(d0 - 2 (d0 - d1) x), x = nu_sheet G/E_sheet
    return shear * (d0 - 2 * (d0 - d1) * x) / (d0 - 2 * (d0 - d1) * x * shear)
