#include "tool/study/stability/step_to_step.hpp"

#include <algorithm>
#include <tuple>

#include "sim/step/trace.hpp"

namespace unravel::tool {

StepToStep::Shares StepToStep::next(const Simulation& simulation) {
    Shares shares;
    const std::span<const SpringState> springs = trace_of(simulation.model, simulation.ws).springs;
    if (springs.size() == springs_.size() && !springs.empty()) {
        std::size_t turned = 0;
        for (std::size_t s = 0; s < springs.size(); ++s) {
            turned += springs[s] != springs_[s] && springs[s] != SpringState::inactive &&
                      springs_[s] != SpringState::inactive;
        }
        shares.flicker = static_cast<double>(turned) / static_cast<double>(springs.size());
    }
    springs_.assign(springs.begin(), springs.end());

    std::vector<Contact> contacts = simulation.state.contacts;
    std::erase_if(contacts, [](const Contact& c) { return c.force < 0; });  // let go
    const auto place = [](const Contact& c) { return std::tuple(c.particle, c.solid); };
    std::size_t stay = 0, changed = 0;
    auto before = contacts_.begin();
    for (const Contact& now : contacts) {
        while (before != contacts_.end() && place(*before) < place(now)) ++before;
        if (before == contacts_.end() || place(*before) != place(now)) continue;
        ++stay;
        changed += before->held != now.held;
    }
    const std::size_t all = contacts.size() + contacts_.size() - stay;
    if (all > 0) {
        shares.chatter = static_cast<double>(changed) / static_cast<double>(all);
        shares.jitter = static_cast<double>(all - stay) / static_cast<double>(all);
    }
    contacts_ = std::move(contacts);
    return shares;
}

}  // namespace unravel::tool
