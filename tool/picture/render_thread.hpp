#pragma once

#include <tbb/concurrent_queue.h>

#include <functional>
#include <future>
#include <thread>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// The thread that owns a GL context for life. Work is done in the order it is given.
class RenderThread {
public:
    RenderThread() : thread_([this] { loop(); }) {}
    ~RenderThread() {
        queue_.push({});
        thread_.join();
    }
    RenderThread(const RenderThread&) = delete;
    RenderThread& operator=(const RenderThread&) = delete;

    /// Does `work` on the thread and waits for it; what it throws is thrown here.
    void run(std::function<void()> work) {
        std::packaged_task<void()> task(std::move(work));
        std::future<void> result = task.get_future();
        queue_.push(std::move(task));
        result.get();
    }

private:
    void loop() {
        for (;;) {
            std::packaged_task<void()> task;
            queue_.pop(task);
            if (!task.valid()) return;
            task();
        }
    }

    tbb::concurrent_bounded_queue<std::packaged_task<void()>> queue_;
    std::thread thread_;
};

}  // namespace unravel::tool
