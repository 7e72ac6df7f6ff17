#include "sim/scene_file/describe.hpp"

namespace unravel::sim {

void describe(Fields& f, Scene& scene) {
    f.text({"root", "folder of the files that the scene names, from its own; default: its own", false,
            !f.writing()},
           scene.root, TextKind::path);
    f.texts(
        {"include",
         "scene files whose tables this one takes over: its own keys replace theirs, and lists of cloths, "
         "solids and cameras are joined, theirs first",
         false, !f.writing()},
        scene.include, TextKind::path);
    f.table({"clip", "what is recorded"}, [&](Fields& g) { describe(g, scene.clip); });
    f.vector({"gravity", "m/s², acceleration of free fall; [0, 0, 0] switches it off"}, scene.gravity,
             {-1000, 1000, false, "m/s²"});
    f.list({"cloth", "a sheet or a tube of cloth; several are written as [[cloth]]", true}, scene.cloths,
           ListForm::tables, [](Fields& g, Cloth& cloth) { describe(g, cloth); });
    f.list({"solid", "rigid bodies that the cloth meets"}, scene.solids, ListForm::tables,
           [](Fields& g, Solid& solid) { describe(g, solid); });
    f.table({"solver", "how the motion is computed"}, [&](Fields& g) { describe(g, scene.solver); });
    f.optional_table({"wind", "air; absent: vacuum"}, scene.wind, Wind{},
                     [](Fields& g, Wind& wind) { describe(g, wind); });
    f.optional_table({"self_collision", "cloth pushes cloth away; absent: it passes through itself"},
                     scene.self_collision, SelfCollision{},
                     [](Fields& g, SelfCollision& self) { describe(g, self); });
    f.list({"camera", "views; the first is the main one"}, scene.cameras, ListForm::tables,
           [](Fields& g, Camera& camera) { describe(g, camera); });
    f.table({"look", "colours and patterns"}, [&](Fields& g) { describe(g, scene.look); });
}

void describe(Fields& f, Clip& clip) {
    f.number({"duration", "s"}, clip.duration, {0, max_time, true, "s"});
    f.rate({"fps", "frames per second; a whole number or a fraction such as \"30000/1001\""}, clip.fps, 1,
           1000);
    f.number({"settle", "s simulated before frame 0 and not shown; what moves stands still meanwhile", false,
              !f.writing() || clip.settle > 0},
             clip.settle, time_bounds);
    f.integers({"size", "pixels, width and height; both even where an mp4 is made"}, clip.size, 16, 8192);
}

void describe(Fields& f, Solver& solver) {
    f.choice({"integrator", "time stepping method"}, solver.integrator);
    f.fraction({"step",
                "a whole part of a frame [s]; a number or a fraction such as \"1/240\"; default: the largest "
                "up to 1/240"},
               solver.step, {1e-7, 1, false, "s"});
    f.integer({"substeps", "parts into which \"explicit\" divides each step; 0: as many as keep it stable"},
              solver.substeps, 0, 1'000'000);
    f.number({"threshold", "springs with (h/m)(k h + 2 k_d) up to this are handled explicitly"},
             solver.threshold, {0, 1e9});
    f.choice({"preconditioner", "of the conjugate gradients"}, solver.preconditioner);
    f.number({"tolerance", "relative preconditioned residual at which a solve ends"}, solver.tolerance,
             {1e-15, 0.5});
    f.integer({"max_iterations", "of the conjugate gradients, per component"}, solver.max_iterations, 1,
              10'000'000);
    f.flag({"decompose", "solve each component of implicitly coupled particles by itself"}, solver.decompose);
    f.choice({"bend",
              "bending as the integrator has it (implicit, newton: implicitly; others: by its own kappa), or "
              "explicit"},
             solver.bend);
    f.choice({"activation",
              "when a slack spring acts: next step, where predicted taut, in a second solve, or as "
              "linearised ahead"},
             solver.activation);
    f.number({"activation_band", "springs this share below their rest length already get their Jacobian"},
             solver.activation_band, {0, 0.5});
    f.optional_table({"adaptive", "step size chosen while running; absent: fixed"}, solver.adaptive,
                     AdaptiveStep{}, [](Fields& g, AdaptiveStep& adaptive) { describe(g, adaptive); });
}

void describe(Fields& f, AdaptiveStep& adaptive) {
    f.place(adaptive.place);
    f.fraction({"smallest", "s, the run stops where this would not do"}, adaptive.smallest,
               {1e-9, 1, false, "s"});
    f.number({"max_strain", "a step that adds more stretch than this is taken again, smaller"},
             adaptive.max_strain, {0, 100, true});
    f.number({"tolerance", "m, local error allowed per step; 0: not tested"}, adaptive.tolerance,
             {0, 1, false, "m"});
}

}  // namespace unravel::sim
