#!/usr/bin/env python3
"""Turns the JSON of convex_cut_compare into a table: performance-report.py COMPARE [STAGES]. With
that of stages_bench as well, writes docs/performance.md and its plots, docs/images/*.svg."""
import json
import math
import pathlib
import sys

PEERS = [("qhull", "Algorithm 1, Qhull"), ("cgal", "Algorithm 1, CGAL"), ("chain", "Algorithm 1, monotone chain"),
         ("pcl", "PCL, planes by RANSAC"), ("engine_1t", "engine, 1 thread"), ("engine_2t", "engine, 2 threads"),
         ("memory", "one pass over the memory")]
COLOURS = ["#888888", "#b07aa1", "#59a14f", "#edc948", "#e15759", "#4e79a7", "#cccccc"]


def milliseconds(case, peer):
    value = case.get(f"{peer}_ms")
    return "" if value is None else f"{value:.2f}" if value < 100 else f"{value:.0f}"


def table(cases):
    lines = ["| cloud | points | tilt | d | Qhull ms | CGAL ms | chain ms | PCL ms | 1 thread ms (p99) | 2 threads ms (p99) "
             "| memory ms | Qhull ÷ 1 thread | Qhull ÷ 2 threads |",
             "|---|---|---|---|---|---|---|---|---|---|---|---|---|"]
    for case in cases:
        lines.append(
            f"| {case['name']} | {case['points']:,} | {case['tilt_deg']}° | {case['half_width_m']} "
            f"| {milliseconds(case, 'qhull')} | {milliseconds(case, 'cgal')} | {milliseconds(case, 'chain')} | {milliseconds(case, 'pcl')} "
            f"| {case['engine_1t_ms']:.2f} ({case['engine_1t_p99_ms']:.2f}) "
            f"| {case['engine_2t_ms']:.2f} ({case['engine_2t_p99_ms']:.2f}) "
            f"| {case['memory_ms']:.3f} | {case['qhull_ms'] / case['engine_1t_ms']:.0f} "
            f"| {case['qhull_ms'] / case['engine_2t_ms']:.0f} |")
    return "\n".join(lines)


def robust_table(rows):
    lines = ["| scene | points | voxels | Qhull ms | robust ms | p99 | max | Qhull ÷ robust | labels at once ms | p99 | learning of 1 in 2, ms a revolution | Qhull ÷ that |",
             "|---|---|---|---|---|---|---|---|---|---|---|---|"]
    for row in rows:
        lines.append(f"| {row['scene']} | {row['points']:,} | {row['voxels']:,} | {row['qhull_ms']:.1f} | {row['robust_ms']:.1f} "
                     f"| {row['robust_p99_ms']:.1f} | {row['robust_max_ms']:.1f} | {row['qhull_ms'] / row['robust_ms']:.1f} "
                     f"| {row['robust_at_once_ms']:.1f} | {row['robust_at_once_p99_ms']:.1f} | {row['robust_thrifty_ms']:.1f} "
                     f"| {row['qhull_ms'] / row['robust_thrifty_ms']:.1f} |")
    return "\n".join(lines)


# From the datagrams to the labels, in order; the peers are the plain decoder and the batch.
STAGES = [("plain_decode", "decoder with point structures and tables (peer)"), ("plain_decode_level", "… and levelling"),
          ("decode", "decode: datagrams to columns"), ("cut", "cut into scans"), ("level", "level by the IMU's track"),
          ("level_fixed", "level a fixed mount"), ("order", "Convex Cut: order"), ("slices", "Convex Cut: cut, hull, keep"),
          ("write_labels", "Convex Cut: write labels"), ("batch", "Convex Cut in all"),
          ("streaming_after_last_firing", "Convex Cut streaming, after the last firing"),
          ("streaming_in_all", "Convex Cut streaming, in all"), ("hand_off_to_publisher", "hand-off to the publisher")]


def stage_table(stages):
    times = {}
    for benchmark in stages["benchmarks"]:
        name = benchmark["run_name"].split("/iterations")[0]
        times.setdefault(name, {"returns": benchmark["returns"]})[benchmark["aggregate_name"]] = benchmark["real_time"]
    lines = ["| stage | input | p50 µs | p99 µs | max µs | ns a return |", "|---|---|---|---|---|---|"]
    for stage, title in STAGES:
        for name, time in times.items():
            if name.split("/")[0] != stage:
                continue
            source = name.partition("/")[2].replace("tilt", "tilt ") + ("°" if "tilt" in name else "")
            each = f"{1000 * time['p50'] / time['returns']:.2f}" if time["returns"] > 1 else ""
            lines.append(f"| {title} | {source} | {time['p50']:.1f} | {time['p99']:.1f} | {time['max']:.1f} | {each} |")
    return "\n".join(lines), times


def plot(cases, tilt_deg, half_width_m):
    """Time against the number of points, both logarithmic."""
    cases = sorted((c for c in cases if c["tilt_deg"] == tilt_deg and c["half_width_m"] == half_width_m),
                   key=lambda c: c["points"])
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
    for value in (10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000):
        svg.append(f'<text x="{x(value):.1f}" y="{height - bottom + 18}" text-anchor="middle" '
                   f'font-size="10">{value / 1000:.0f}k</text>')
    svg.append(f'<text x="{(left + width) / 2}" y="{height - 10}" text-anchor="middle">points in the cloud</text>')
    measured = [(peer, name, colour) for (peer, name), colour in zip(PEERS, COLOURS) if any(f"{peer}_ms" in c for c in cases)]
    for row, (peer, name, colour) in enumerate(measured):
        line = " ".join(f"{x(c['points']):.1f},{y(c[f'{peer}_ms']):.1f}" for c in cases if f"{peer}_ms" in c)
        svg.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>'
                   f'<rect x="{width}" y="{30 + 22 * row}" width="14" height="4" fill="{colour}"/>'
                   f'<text x="{width + 22}" y="{37 + 22 * row}">{name}</text>')
    return "\n".join(svg + ["</svg>\n"])


def main():
    report = json.loads(pathlib.Path(sys.argv[1]).read_text())
    # Of the many sizes, those with all peers.
    rows = table([c for c in report["cases"] if "cgal_ms" in c or not c["name"].startswith("size_")])
    robust = robust_table(report["robust"])
    print(f"{rows}\n\n{robust}\n")
    for key, value in report.items():
        if key.startswith("ratio"):
            print(f"{key} = {value}")
    if len(sys.argv) < 3:
        return
    stages, times = stage_table(json.loads(pathlib.Path(sys.argv[2]).read_text()))
    print(f"\n{stages}")
    share = {tilt: times[f"streaming_after_last_firing/tilt{tilt}"]["p50"] / times[f"batch/tilt{tilt}"]["p50"]
             for tilt in (0, 30, 60)}
    docs = pathlib.Path(__file__).resolve().parent.parent / "docs"
    (docs / "images").mkdir(exist_ok=True)
    (docs / "images" / "performance.svg").write_text(plot(report["cases"], 0, 0.05))
    (docs / "performance.md").write_text(f"""# Performance of Convex Cut

Written by `./bench.sh`: medians of runs that take turns, on a simulated furnished room seen by an HDL-32E, with 360 planes and
e = 0.08 m; the engine with the instruction set `{report['simd']}`. Times are those of one machine; the ratios within the run are what
counts. *Algorithm 1* is the paper's, literally: every plane looks at every point, takes the hull of its slice from a library and
tests the slice's points against it. *PCL* takes planes out of the cloud by RANSAC, up to ten, until a tenth of the points is left: the
usual way to walls, floor and ceiling, for time only, as fronts of furniture are planes too. *Memory* is one pass over the cloud's coordinates: the floor of any method. The
engine's labels differ from those of Algorithm 1 with Qhull in
{max(case['differing_labels'] for case in report['cases']):.0f} points at most.

![Time against the number of points](images/performance.svg)

The plot has {sum(c['name'].startswith('size_') for c in report['cases'])} sizes from 10,000 to 3 million points, the table those at which all peers ran.

{rows}

## The robust method

On one thread, its window of 30 revolutions full, in two of the simulator's scenes (`docs/scenes.md`; tilt 30°, turning by 6° a
revolution), in turns with Algorithm 1 with Qhull on a revolution of the same scene. *Labels at once* (`convex_cut.learn_first = false`)
are those by the revolutions before; each revolution is learnt from when its labels are handed over, with less effort every second one
(*learning of 1 in 2*: everything, on the average of two revolutions).

{robust}

## Stages

Of one revolution on one thread, in turns and in one run, in microseconds. *room*: every return there, *outdoors*: a quarter missing.
The time that remains after the last firing when Convex Cut streams is {share[0]:.2f} of the batch's time at tilt 0°, {share[30]:.2f} at 30° and
{share[60]:.2f} at 60°, where beams reach below the sensor and with that into every slice.

{stages}
""")


main()
