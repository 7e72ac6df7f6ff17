#include "tests/allocations.hpp"

#include <cstdlib>
#include <new>

namespace {

thread_local long allocations = 0;

}  // namespace

// The array and nothrow forms come here, too; the aligned ones are libstdc++'s own pair.
void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
    throw std::bad_alloc();
}

void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace unravel::testing {

AllocationCount::AllocationCount() : before_(allocations) {}

long AllocationCount::so_far() const {
    return allocations - before_;
}

}  // namespace unravel::testing
