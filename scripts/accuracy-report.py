#!/usr/bin/env python3
"""Turns the JSON files of convexcut_accuracy into tables, and with --write-docs into docs/accuracy.md."""
import json
import pathlib
import sys

METHODS = ["paper", "robust", "farthest-column", "half-space RANSAC", "3D hull"]
PAPER = {"office": "0.900 ± 0.040 / 0.992 ± 0.019", "cafe": "0.865 / 0.863",
         "moving": "0.900 ± 0.103 / 0.776 ± 0.179"}
GOALS = [("mean F over all scenes", 0.985), ("worst scan", 0.93), ("patch precision", 0.97), ("patch recall", 0.98)]


def weighted(rows, key, field="points"):
    count = sum(r[field]["n"] for r in rows)
    return sum(r[field]["n"] * r[field][key] for r in rows) / count if count else float("nan")


def worst(rows, field="points"):
    return min((r[field]["worst"] for r in rows if r[field]["n"]), default=float("nan"))


def pooled_patches(rows):
    _, kept_objects, kept, lost = (sum(r["patch_counts"][i] for r in rows) for i in range(4))
    return (kept / (kept + kept_objects) if kept + kept_objects else float("nan"),
            kept / (kept + lost) if kept + lost else float("nan"))


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def unique(rows, key):
    return list(dict.fromkeys(r[key] for r in rows))


def overall(rows):
    lines = []
    for method in METHODS:
        of = [r for r in rows if r["method"] == method]
        patch_precision, patch_recall = pooled_patches(of)
        lines.append([method, f"{weighted(of, 'p'):.3f}", f"{weighted(of, 'r'):.3f}", f"**{weighted(of, 'f'):.3f}**",
                      f"{worst(of):.3f}", f"{weighted(of, 'f', 'settled'):.3f}", f"{worst(of, 'settled'):.3f}",
                      f"{patch_precision:.3f} / {patch_recall:.3f}", f"{sum(r['ms'] for r in of) / len(of):.1f}"])
    return table(["method", "P", "R", "F", "worst scan", "F after 1 s", "worst after 1 s", "patch P / R", "CPU ms a scan"],
                 lines)


def by_scene(rows):
    lines = []
    for scene in unique(rows, "scene"):
        for tilt in unique(rows, "tilt"):
            of = [r for r in rows if r["scene"] == scene and r["tilt"] == tilt]
            cells = [f"{weighted(m, 'f'):.3f} ({worst(m):.3f})"
                     for m in ([r for r in of if r["method"] == method] for method in METHODS)]
            lines.append([scene, f"{tilt}°"] + cells)
    return table(["scene", "tilt"] + METHODS, lines)


def by_variant(rows, field="f"):
    variants = unique(rows, "variant")
    lines = []
    for method in METHODS:
        values = [weighted([r for r in rows if r["method"] == method and r["variant"] == v], field) for v in variants]
        lines.append([method] + [f"{value:.4f}" + (f" ({value - values[0]:+.4f})" if i else "")
                                 for i, value in enumerate(values)])
    return table(["method"] + variants, lines)


def crowds(rows):
    """How much of what is seen is people, by their number; in the last column upright and tilted."""
    robust = [r for r in rows if r["method"] == "robust"]
    lines = []
    for scene in unique(rows, "scene"):
        cells = []
        for variant in unique(rows, "variant"):
            shares = [r["dynamic"] for r in robust if (r["scene"], r["variant"]) == (scene, variant)]
            cells.append(f"{sum(shares) / len(shares):.0%}")
        lines.append([scene] + cells + [" / ".join(f"{share:.0%}" for share in shares)])
    most = f"{unique(rows, 'variant')[-1]} at " + " / ".join(f"{t}°" for t in unique(rows, "tilt"))
    return table(["scene"] + unique(rows, "variant") + [most], lines)


def mirror(rows):
    lines = []
    for method in METHODS:
        of = [r for r in rows if r["method"] == method]
        cells = [f"{r['unjudged_kept'] / r['unjudged']:.1%}" if r["unjudged"] else "–" for r in of]
        lines.append([method] + cells + [f"{weighted(of, 'f'):.3f}"])
    return table(["method"] + [f"{t}°" for t in unique(rows, "tilt")] + ["F"], lines)


def ablation(rows):
    whole = [r for r in rows if r["method"] == "robust"]
    lines = []
    for method in unique(rows, "method"):
        of = [r for r in rows if r["method"] == method]
        lines.append([method, f"{weighted(of, 'p'):.4f}", f"{weighted(of, 'r'):.4f}", f"{weighted(of, 'f'):.4f}",
                      f"{weighted(of, 'f') - weighted(whole, 'f'):+.4f}", f"{worst(of):.3f}",
                      f"{sum(r['ms'] for r in of) / len(of):.1f}"])
    return table(["robust", "P", "R", "F", "change", "worst scan", "CPU ms a scan"], lines)


def paper_experiment(name, rows):
    lines = [["the paper's figure", PAPER[name], "", "", ""]]
    for method in unique(rows, "method"):
        of = [r for r in rows if r["method"] == method]
        if len(of) == 1:
            p, r = of[0]["patches"], of[0]["points"]
            patch = f"{p['p']:.3f} ± {p['p_sd']:.3f} / {p['r']:.3f} ± {p['r_sd']:.3f}"
            point = f"{r['p']:.3f} ± {r['p_sd']:.3f} / {r['r']:.3f} ± {r['r_sd']:.3f}"
        else:
            patch = " / ".join(spread([r["patches"][k] for r in of]) for k in "pr")
            point = " / ".join(spread([r["points"][k] for r in of]) for k in "pr")
        lines.append([method, patch, point, f"{weighted(of, 'f'):.3f}", f"{worst(of):.3f}"])
    return table(["method", "patch P / R", "point P / R", "point F", "worst"], lines)


def spread(values):
    mean = sum(values) / len(values)
    deviation = (sum((v - mean) ** 2 for v in values) / max(len(values) - 1, 1)) ** 0.5
    return f"{mean:.3f} ± {deviation:.3f}"


def cost(rows, variant):
    """What a variant costs robust in F, against the first one."""
    robust = [r for r in rows if r["method"] == "robust"]
    first = unique(rows, "variant")[0]
    return (weighted([r for r in robust if r["variant"] == first], "f")
            - weighted([r for r in robust if r["variant"] == variant], "f"))


def misses(data):
    robust = [r for r in data["scenes"] if r["method"] == "robust"]
    patch_precision, patch_recall = pooled_patches(robust)
    lines = []
    for (name, goal), value in zip(GOALS, [weighted(robust, "f"), worst(robust), patch_precision, patch_recall]):
        lines.append([name, f"≥ {goal}", f"{value:.3f}", "met" if value >= goal else f"missed by {goal - value:.3f}"])
    crowd = unique(data["dynamic"], "variant")[-1]
    kept = max(r["unjudged_kept"] / r["unjudged"] for r in data["mirror"] if r["method"] == "robust" and r["unjudged"])
    for name, goal, value in [("F lost to 1 % ghosts", 0.003, cost(data["ghosts"], "1 %")),
                              ("F lost to 5° of gravity", 0.003, cost(data["gravity"], "5°")),
                              (f"F lost to {crowd} people", 0.01, cost(data["dynamic"], crowd)),
                              ("share of a mirror image kept, worst tilt", 0.15, kept)]:
        lines.append([name, f"≤ {goal}", f"{value:.4f}", "met" if value <= goal else f"missed by {value - goal:.4f}"])
    return table(["of robust", "goal", "measured", ""], lines)


def behind(rows):
    """Where a rival is ahead of robust."""
    found = []
    for scene in unique(rows, "scene"):
        for tilt in unique(rows, "tilt"):
            f = {m: weighted([r for r in rows if (r["scene"], r["tilt"], r["method"]) == (scene, tilt, m)], "f")
                 for m in METHODS}
            best = max(f, key=f.get)
            if best != "robust":
                found.append(f"`{scene}` at {tilt}° ({best} {f[best]:.3f}, robust {f['robust']:.3f})")
    return ", ".join(found) or "nowhere"


def worst_places(rows):
    robust = [r for r in rows if r["method"] == "robust"]
    groups = {}
    for r in robust:
        groups.setdefault((r["scene"], r["tilt"]), []).append(r)
    ranked = sorted(groups.items(), key=lambda item: weighted(item[1], "f"))[:6]
    return ", ".join(f"`{scene}` at {tilt}° (F {weighted(of, 'f'):.3f}, P {weighted(of, 'p'):.3f}, "
                     f"R {weighted(of, 'r'):.3f})" for (scene, tilt), of in ranked)


def report(data):
    template = (pathlib.Path(__file__).with_name("accuracy-report.md")).read_text()
    values = {"overall": overall(data["scenes"]), "misses": misses(data), "behind": behind(data["scenes"]),
              "worst_places": worst_places(data["scenes"]), "by_scene": by_scene(data["scenes"]),
              "ghosts": by_variant(data["ghosts"]), "gravity": by_variant(data["gravity"]),
              "dynamic": by_variant(data["dynamic"]), "crowds": crowds(data["dynamic"]),
              "dynamic_office": by_variant([r for r in data["dynamic"] if r["scene"] == "office"]),
              "mirror": mirror(data["mirror"]), "ablation": ablation(data["ablation"])}
    for name in ("office", "cafe", "moving"):
        rows = data[name]
        values[name] = paper_experiment(name, rows)
        first = [r for r in rows if r["method"] == "robust"]
        values[f"{name}_scans"] = str(sum(r["points"]["n"] for r in first))
    values["seeds"] = ", ".join(str(s) for s in unique(data["scenes"], "seed"))
    values["scans"] = str(sum(r["points"]["n"] for r in data["scenes"] if r["method"] == "robust"))
    for name, value in values.items():
        template = template.replace("{" + name + "}", value)
    return template


def main():
    results = pathlib.Path(sys.argv[1])
    data = {file.stem: json.loads(file.read_text()) for file in results.glob("*.json")}
    text = report(data)
    print(text)
    if "--write-docs" in sys.argv[2:]:
        docs = pathlib.Path(__file__).resolve().parent.parent / "docs"
        (docs / "accuracy.md").write_text(text)


main()
