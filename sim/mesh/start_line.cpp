#include "sim/mesh/start_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace unravel::sim {

namespace {

constexpr double pi = std::numbers::pi;

// Narrower, arcs of neighbouring pleats would meet: they do where each turns by 150 degrees to either side.
constexpr double narrowest_pleats = 0.25;
// A roll's hollow, and panels between folds, are at least this many gaps wide.
constexpr double least_gaps = 2;

Vec2 direction(double angle) {
    return {std::cos(angle), std::sin(angle)};
}

// Where a piece of which `s` is covered leads, from its own beginning.
Vec2 along_piece(double heading, double s, double turn) {
    // The chord of an arc: its direction is the mean one, and it is shorter by sin(t)/t.
    const double half = 0.5 * turn;
    const double chord = std::abs(half) > 1e-8 ? s * std::sin(half) / half : s;
    return chord * direction(heading + half);
}

// Half of the turn of an arc whose chord is this share of it: sin(a)/a = share.
double half_turn_of(double share) {
    double low = 0, high = pi;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (std::sin(middle) / middle > share ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double pleated_width(const Start& start, double length) {
    return start.width > 0 ? start.width : 0.5 * length;
}

// Waves that begin and end on a crest.
StartLine pleats(const Start& start, double length) {
    const double width = pleated_width(start, length), half_wave = length / (2 * start.pleats);
    const double turn = width < length ? half_turn_of(width / length) : 0;
    StartLine line;
    line.pieces.push_back({0.5 * half_wave, -turn});
    for (int k = 1; k < 2 * start.pleats; ++k)
        line.pieces.push_back({half_wave, k % 2 == 1 ? 2 * turn : -2 * turn});
    line.pieces.push_back({0.5 * half_wave, -turn});
    const double radius = turn > 0 ? half_wave / (2 * turn) : 0;
    line.origin = {0.5 * width, -radius * (1 - std::cos(turn))};
    return line;
}

double panel_of(const Start& start, double length) {
    return (length - start.folds * 0.5 * pi * start.gap) / (start.folds + 1);
}

// Layers on top of each other, to and fro.
StartLine layers(const Start& start, double length) {
    const double panel = panel_of(start, length);
    StartLine line;
    for (int k = 0; k < start.folds; ++k) {
        line.pieces.push_back({panel, 0});
        line.pieces.push_back({0.5 * pi * start.gap, k % 2 == 0 ? pi : -pi});
    }
    line.pieces.push_back({panel, 0});
    line.origin = {0.5 * panel, 0.5 * start.folds * start.gap};
    return line;
}

// Half turns whose radius grows by half a gap each, from the inside, front within; then what is left flat,
// which leads away below.
StartLine roll(const Start& start, double length) {
    StartLine line;
    double left = length - start.flat, radius = start.radius, turned = 0;
    while (left > 0) {
        const double part = std::min(left, pi * radius);
        line.pieces.push_back({part, part / radius});
        turned += part / radius;
        left -= part;
        if (left > 0) radius += 0.5 * start.gap;
    }
    if (start.flat > 0) line.pieces.push_back({start.flat, 0});
    line.heading = -turned;
    Vec2 end(0, 0);
    double heading = line.heading;
    for (const StartLine::Piece& piece : line.pieces) {
        if (piece.turn == 0) break;
        end += along_piece(heading, piece.length, piece.turn);
        heading += piece.turn;
    }
    line.origin = end + Vec2(0, radius);
    return line;
}

// Up, over, and down again.
StartLine over_bar(const Start& start, double length) {
    const double bend = pi * start.radius, before = start.share * length - 0.5 * bend;
    StartLine line;
    line.heading = 0.5 * pi;
    line.pieces = {{before, 0}, {bend, -pi}, {length - before - bend, 0}};
    line.origin = {start.radius, before};
    return line;
}

}  // namespace

LinePoint point_along(const StartLine& line, double s) {
    Vec2 at = -line.origin;
    double heading = line.heading;
    if (s > 0) {
        for (const StartLine::Piece& piece : line.pieces) {
            const double part = std::min(s, piece.length);
            const double turn = piece.length > 0 ? piece.turn * part / piece.length : 0;
            at += along_piece(heading, part, turn);
            heading += turn;
            s -= part;
            if (s <= 0) break;
        }
    }
    // Rounding may leave a trifle beyond the end.
    at += s * direction(heading);
    return {at, direction(heading + 0.5 * pi)};
}

StartLine make_start_line(const Start& start, double length) {
    switch (start.shape) {
        case StartShape::pleated:
            return pleats(start, length);
        case StartShape::folded:
            return layers(start, length);
        case StartShape::rolled:
            return roll(start, length);
        case StartShape::over_bar:
            break;
    }
    return over_bar(start, length);
}

UnfitStart unfit_start(const Start& start, double length) {
    switch (start.shape) {
        case StartShape::pleated:
            if (pleated_width(start, length) < narrowest_pleats * length || start.width > length)
                return {fmt::format("a cloth of {:.4g} m pleated to {:.4g} m", length, start.width),
                        fmt::format("it is from {:.4g} to {:.4g} m", narrowest_pleats * length, length)};
            break;
        case StartShape::folded:
            if (panel_of(start, length) < least_gaps * start.gap)
                return {fmt::format("{} folds with gaps of {:.4g} m in {:.4g} m of cloth", start.folds,
                                    start.gap, length),
                        "fold it less often, or with a smaller gap"};
            break;
        case StartShape::rolled:
            if (start.radius < least_gaps * start.gap)
                return {fmt::format("a roll with a hollow of {:.4g} m", start.radius),
                        fmt::format("it is at least twice the gap, {:.4g} m", least_gaps * start.gap)};
            if (start.flat >= length)
                return {fmt::format("{:.4g} m left flat of {:.4g} m", start.flat, length),
                        "some of it is to be rolled"};
            break;
        case StartShape::over_bar: {
            const double half = 0.5 * pi * start.radius, least = std::min(start.share, 1 - start.share);
            if (least * length < half)
                return {
                    fmt::format("a bend of {:.4g} m, of which {:.4g} m are on either side of the bar's top",
                                2 * half, least * length),
                    "make the radius smaller, or share nearer to 0.5"};
            break;
        }
    }
    return {};
}

}  // namespace unravel::sim
