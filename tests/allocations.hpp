#pragma once

namespace unravel::testing {

/// Counts what operator new gives out on this thread while it lives. The whole test program's operator new is
/// replaced (allocations.cpp); what a driver takes by malloc is not counted.
class AllocationCount {
public:
    AllocationCount();
    long so_far() const;

private:
    long before_;
};

}  // namespace unravel::testing
