#include "tool/bench/fit.hpp"

#include <cmath>

namespace unravel::tool {

double PowerLaw::at(double n) const {
    return factor * std::pow(n, exponent);
}

PowerLaw fit_power(std::span<const Measured> points, double from) {
    double count = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const Measured& p : points) {
        if (!(p.n >= from && p.n > 0 && p.t > 0)) continue;
        const double a = std::log(p.n), b = std::log(p.t);
        count += 1;
        x += a;
        y += b;
        xx += a * a;
        xy += a * b;
    }
    PowerLaw law;
    const double spread = count * xx - x * x;
    if (count < 2 || !(spread > 1e-9 * count * xx)) return law;
    law.exponent = (count * xy - x * y) / spread;
    law.factor = std::exp((y - law.exponent * x) / count);
    law.points = static_cast<int>(count);
    return law;
}

}  // namespace unravel::tool
