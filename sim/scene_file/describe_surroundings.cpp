#include "sim/scene_file/describe.hpp"

namespace unravel::sim {

void describe(Fields& f, Wind& wind) {
    f.place(wind.place);
    f.vector({"velocity", "m/s; zero: still air that resists"}, wind.velocity, speed_bounds);
    f.list({"keyframes", "velocity over time, instead of `velocity`"}, wind.keyframes,
           ListForm::inline_tables, in_order<WindKey>());
    f.optional_table(
        {"gust", "a smooth random factor on the wind"}, wind.gust, Gust{}, [](Fields& g, Gust& gust) {
            g.number({"strength", "standard deviation of the speed over its mean"}, gust.strength, {0, 10});
            g.number({"period", "s"}, gust.period, {1e-3, max_time, false, "s"});
            g.seed({"seed", "another seed, other gusts"}, gust.seed);
        });
    f.number({"density", "kg/m³, of the air"}, wind.density, {0, 1e4, false, "kg/m³"});
    f.number({"drag", "coefficient on the velocity along the cloth's normal"}, wind.drag, {0, 1000});
    f.number({"lift", "coefficient on the velocity along the cloth"}, wind.lift, {0, 1000});
}

void describe(Fields& f, WindKey& key) {
    f.number({"time", "s", true}, key.time, time_bounds);
    f.vector({"velocity", "m/s", true}, key.velocity, speed_bounds);
}

void describe(Fields& f, SelfCollision& self) {
    f.place(self.place);
    f.choice(
        {"method",
         "what touches what: vertices, edges and faces of the cloth, or particles alone as in the paper"},
        self.method);
    const bool surface = self.method == ContactMethod::surface || (!f.reading() && !f.writing());
    f.number({"thickness",
              "m, at which layers touch; 0: 0.75 of the particle spacing, or where surfaces touch that of "
              "cloth of 100 kg/m³"},
             self.thickness, {0, 1, false, "m"});
    f.number({"stiffness", "N/m of a contact; 0: from the material"}, self.stiffness, {0, 1e9, false, "N/m"});
    f.number({"damping", "N·s/m of a contact; where surfaces touch, 0 is a fifth of critical"}, self.damping,
             {0, 1e6, false, "N·s/m"});
    describe_friction(f,
                      {"friction",
                       "between layers, where surfaces touch: a number, or {static, kinetic}; a number mu "
                       "stands for static mu, kinetic 0.8 mu",
                       false, surface},
                      self.friction);
}

}  // namespace unravel::sim
