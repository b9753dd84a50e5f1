#!/usr/bin/env python3
"""Turns the JSON of convex_cut_compare into a table, and with --write-docs into docs/performance.md
and docs/images/performance.svg."""
import json
import math
import pathlib
import sys

PEERS = [("qhull", "Algorithm 1, Qhull"), ("cgal", "Algorithm 1, CGAL"), ("chain", "Algorithm 1, monotone chain"),
         ("engine_1t", "engine, 1 thread"), ("engine_2t", "engine, 2 threads"), ("memory", "one pass over the memory")]
COLOURS = ["#888888", "#b07aa1", "#59a14f", "#e15759", "#4e79a7", "#cccccc"]


def milliseconds(case, peer):
    value = case.get(f"{peer}_ms")
    return "" if value is None else f"{value:.2f}" if value < 100 else f"{value:.0f}"


def table(cases):
    lines = ["| cloud | points | tilt | d | Qhull ms | CGAL ms | chain ms | 1 thread ms (p99) | 2 threads ms (p99) "
             "| memory ms | Qhull ÷ 1 thread | Qhull ÷ 2 threads |",
             "|---|---|---|---|---|---|---|---|---|---|---|---|"]
    for case in cases:
        lines.append(
            f"| {case['name']} | {case['points']:,} | {case['tilt_deg']}° | {case['half_width_m']} "
            f"| {milliseconds(case, 'qhull')} | {milliseconds(case, 'cgal')} | {milliseconds(case, 'chain')} "
            f"| {case['engine_1t_ms']:.2f} ({case['engine_1t_p99_ms']:.2f}) "
            f"| {case['engine_2t_ms']:.2f} ({case['engine_2t_p99_ms']:.2f}) "
            f"| {case['memory_ms']:.3f} | {case['qhull_ms'] / case['engine_1t_ms']:.0f} "
            f"| {case['qhull_ms'] / case['engine_2t_ms']:.0f} |")
    return "\n".join(lines)


def plot(cases):
    """Time against the number of points, both logarithmic."""
    cases = sorted((c for c in cases if c["tilt_deg"] == 0 and c["half_width_m"] == 0.05), key=lambda c: c["points"])
    width, height, left, bottom = 720, 420, 70, 50
    points = [c["points"] for c in cases]
    times = [c[f"{peer}_ms"] for c in cases for peer, _ in PEERS if f"{peer}_ms" in c]
    low_x, high_x = math.log10(min(points)), math.log10(max(points))
    low_y, high_y = math.floor(math.log10(min(times))), math.ceil(math.log10(max(times)))

    def x(value):
        return left + (math.log10(value) - low_x) / (high_x - low_x) * (width - left - 20)

    def y(value):
        return height - bottom - (math.log10(value) - low_y) / (high_y - low_y) * (height - bottom - 20)

    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width + 220} {height}" font-family="sans-serif" '
           f'font-size="12"><rect width="100%" height="100%" fill="white"/>']
    for decade in range(low_y, high_y + 1):
        svg.append(f'<line x1="{left}" x2="{width - 20}" y1="{y(10 ** decade):.1f}" y2="{y(10 ** decade):.1f}" '
                   f'stroke="#eee"/><text x="{left - 8}" y="{y(10 ** decade) + 4:.1f}" text-anchor="end">'
                   f'{10.0 ** decade:g} ms</text>')
    for value in points:
        svg.append(f'<text x="{x(value):.1f}" y="{height - bottom + 18}" text-anchor="middle" '
                   f'font-size="10">{value / 1000:.0f}k</text>')
    svg.append(f'<text x="{(left + width) / 2}" y="{height - 10}" text-anchor="middle">points in the cloud</text>')
    for row, ((peer, name), colour) in enumerate(zip(PEERS, COLOURS)):
        line = " ".join(f"{x(c['points']):.1f},{y(c[f'{peer}_ms']):.1f}" for c in cases if f"{peer}_ms" in c)
        svg.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>'
                   f'<rect x="{width}" y="{30 + 22 * row}" width="14" height="4" fill="{colour}"/>'
                   f'<text x="{width + 22}" y="{37 + 22 * row}">{name}</text>')
    return "\n".join(svg + ["</svg>\n"])


def main():
    report = json.loads(pathlib.Path(sys.argv[1]).read_text())
    print(table(report["cases"]))
    print()
    for key, value in report.items():
        if key.startswith("ratio"):
            print(f"{key} = {value}")
    if "--write-docs" not in sys.argv[2:]:
        return
    docs = pathlib.Path(__file__).resolve().parent.parent / "docs"
    (docs / "images").mkdir(exist_ok=True)
    (docs / "images" / "performance.svg").write_text(plot(report["cases"]))
    (docs / "performance.md").write_text(f"""# Performance of Convex Cut

Written by `./bench.sh`: medians of runs that take turns, on a simulated furnished room seen by an HDL-32E, with 360 planes and
e = 0.08 m; the engine with the instruction set `{report['simd']}`. Times are those of one machine; the ratios within the run are what
counts. *Algorithm 1* is the paper's, literally: every plane looks at every point, takes the hull of its slice from a library and
tests the slice's points against it. All label alike: the engine's labels differ from those of Algorithm 1 with Qhull in
{max(case['differing_labels'] for case in report['cases']):.0f} points at most.

![Time against the number of points](images/performance.svg)

{table(report['cases'])}
""")


main()
