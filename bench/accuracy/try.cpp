#include <cstdio>
#include <cstring>
#include <sstream>

#include "bench/accuracy/run.hpp"
#include "core/convex_cut/robust/robust_cut.hpp"
using namespace convexcut;
using namespace convexcut::bench;
int main(int argc, char** argv) {
  std::string scenes = "office,cafe,glass-offices,corridor,house,hall,l-shape,library",
              tilts = "0,30,60";
  int seeds = 1, seed0 = 1;
  double sec = 3, rot = 60, ghosts = 0, gravity = 0;
  size_t patches = 0, every = 5;
  std::string set = "c";
  bool travels = false, per = false;
  for (int i = 1; i < argc; ++i) {
    auto a = [&](const char* n) { return !strcmp(argv[i], n); };
    if (a("-s"))
      scenes = argv[++i];
    else if (a("-t"))
      tilts = argv[++i];
    else if (a("-n"))
      seeds = atoi(argv[++i]);
    else if (a("--seed"))
      seed0 = atoi(argv[++i]);
    else if (a("--sec"))
      sec = atof(argv[++i]);
    else if (a("--rot"))
      rot = atof(argv[++i]);
    else if (a("--ghosts"))
      ghosts = atof(argv[++i]);
    else if (a("--gravity"))
      gravity = atof(argv[++i]);
    else if (a("--patches"))
      patches = atoi(argv[++i]);
    else if (a("--every"))
      every = atoi(argv[++i]);
    else if (a("--set"))
      set = argv[++i];
    else if (a("--travel"))
      travels = true;
    else if (a("--per"))
      per = true;
  }
  auto methods = set == "a" ? ablations() : compared_methods();
  if (set == "r") methods = {methods[1]};
  if (set == "rp") methods = {methods[0], methods[1]};
  if (set == "t") methods = {methods[1], robust_with_positions()};
  std::vector<evaluation::ScoreSummary> tot(methods.size()), pat(methods.size());
  std::stringstream ss(scenes);
  std::string sc;
  while (std::getline(ss, sc, ',')) {
    std::stringstream ts(tilts);
    std::string t;
    while (std::getline(ts, t, ','))
      for (int s = 0; s < seeds; ++s) {
        Run r;
        r.scene = sc;
        r.judge_every = every;
        r.judge_patches_every = patches;
        r.options.simulation.seed = uint64_t(seed0 + s);
        r.options.simulation.length = std::chrono::milliseconds(int(sec * 1000));
        r.options.simulation.rig = simulation::planned_rig(simulation::Scene::open(sc), travels);
        r.options.simulation.rig.tilt = Degrees{atof(t.c_str())};
        r.options.simulation.rig.rotation_per_second = Degrees{rot};
        r.options.simulation.lidar.ghosts = ghosts;
        r.options.simulation.imu_errors.gravity = Degrees{gravity};
        if (set == "d") {
          auto scn = simulation::Scene::open(sc);
          simulation::LabelledScans ls(scn, r.options);
          simulation::LabelledScan l;
          RobustCut rob({}, 150000);
          std::vector<Label> lab;
          size_t k = 0;
          while (ls.next(l)) {
            lab.assign(l.scan.size(), Label::other);
            (void)rob.label(l.scan.cloud(), lab);
            ++k;
          }
          auto& m = rob.model();
          auto P0 = scn.rig().position;
          printf(
              "scans %zu surfels %zu planes %zu floor %.2f ceil %.2f noise %.4f rig %.1f %.1f %.1f "
              "(coordinates: scene)\n",
              k, m.surfels.size(), m.planes.size(), m.floor_z, m.ceiling_z, std::sqrt(m.noise2),
              P0.x(), P0.y(), P0.z());
          for (size_t q = 0; q < m.planes.size(); ++q) {
            auto& p = m.planes[q];
            printf(" plane %zu n %.2f %.2f %.2f o %.2f surfels %u rms %.3f accepted %d\n", q,
                   p.normal.x(), p.normal.y(), p.normal.z(), p.offset, p.surfels,
                   std::sqrt(p.spread2), p.accepted);
          }
          for (auto& g : m.segments) {
            auto& p = m.planes[g.plane];
            Vec3f al = Vec3f::UnitZ().cross(p.normal).normalized(),
                  a = al * g.begin_m - p.normal * p.offset, b = al * g.end_m - p.normal * p.offset;
            printf(
                "  seg %zu (%.2f %.2f)-(%.2f %.2f) z %.2f..%.2f closed %u open %u narrow %d furn "
                "%d -> %d\n",
                g.plane, a.x() + P0.x(), a.y() + P0.y(), b.x() + P0.x(), b.y() + P0.y(),
                g.bottom_m + P0.z(), g.top_m + P0.z(), g.closed, g.open, g.narrow, g.furniture,
                g.accepted);
          }
          continue;
        }
        auto out = outcomes_of(r, methods);
        printf("%-14s %2s %d", sc.c_str(), t.c_str(), seed0 + s);
        for (size_t m = 0; m < out.size(); ++m) {
          auto& o = out[m];
          printf(" | %.8s P %.3f R %.3f F %.4f w %.3f@%zu", o.method.c_str(),
                 o.points.precision.mean(), o.points.recall.mean(), o.points.f.mean(),
                 o.points.f.worst(), o.points.f.worst_at());
          if (patches)
            printf(" pat %.3f %.3f", score_of(o.pooled_patches).precision,
                   score_of(o.pooled_patches).recall);
          if (m < 2) printf(" %.0fms", o.milliseconds / double(o.scans));
          if (ghosts == 0 && o.pooled.unjudged)
            printf(" unj %.2f", double(o.pooled.unjudged_kept) / double(o.pooled.unjudged));
          if (per && m + 1 == out.size()) {
            auto scn = simulation::Scene::open(sc);
            double all = 0;
            for (auto& q : o.by_surface) all += q.points;
            std::vector<size_t> ix;
            for (size_t k = 0; k < o.by_surface.size(); ++k) ix.push_back(k);
            std::sort(ix.begin(), ix.end(), [&](size_t a, size_t b) {
              return o.by_surface[a].wrong > o.by_surface[b].wrong;
            });
            for (size_t k = 0; k < std::min<size_t>(14, ix.size()); ++k) {
              auto& q = o.by_surface[ix[k]];
              printf("\n     %-28s label %d points %.2f%% wrong %.2f%% (of own %.2f)",
                     scn.surfaces()[ix[k]].name.c_str(), int(scn.surfaces()[ix[k]].label),
                     100 * q.points / all, 100 * q.wrong / all, double(q.wrong) / double(q.points));
            }
          }
          tot[m].precision.add(o.points.precision.mean());
          tot[m].recall.add(o.points.recall.mean());
          tot[m].f.add(o.points.f.mean());
        }
        printf("\n");
        fflush(stdout);
      }
  }
  for (size_t m = 0; m < methods.size(); ++m)
    printf("%-22s P %.4f R %.4f F %.4f worst run %.4f\n", methods[m].name.c_str(),
           tot[m].precision.mean(), tot[m].recall.mean(), tot[m].f.mean(), tot[m].f.worst());
}
