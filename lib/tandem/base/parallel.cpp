#include "tandem/base/parallel.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace tandem {

namespace {

std::atomic<int> limit = 0;

/// Whether this thread works on a loop. The loops within it take no threads of their own.
thread_local bool is_in_loop = false;

/// The numbers of a loop, which threads take one after the other.
class Numbers {
  public:
    Numbers(std::size_t count, const std::function<void(std::size_t)>& work) : count_(count), work_(work) {}

    /// Works until no number is left or one has failed. By then all lower numbers have been taken, so the lowest number
    /// that fails does not depend on the threads.
    void work() {
        const bool was_in_loop = std::exchange(is_in_loop, true);
        while (!has_failed_) {
            const std::size_t number = next_++;
            if (number >= count_) break;
            try {
                work_(number);
            } catch (...) {
                keep(std::current_exception(), number);
            }
        }
        is_in_loop = was_in_loop;
    }

    void pass_on_failure() const {
        if (failure_) std::rethrow_exception(failure_);
    }

  private:
    void keep(std::exception_ptr failure, std::size_t number) {
        const std::lock_guard lock(mutex_);
        if (number < failed_) {
            failed_ = number;
            failure_ = std::move(failure);
        }
        has_failed_ = true;
    }

    const std::size_t count_;
    const std::function<void(std::size_t)>& work_;
    std::atomic<std::size_t> next_ = 0;
    std::atomic<bool> has_failed_ = false;
    std::mutex mutex_;
    std::size_t failed_ = static_cast<std::size_t>(-1);
    std::exception_ptr failure_;
};

}  // namespace

void set_thread_limit(int threads) { limit = std::max(0, threads); }

int thread_limit() {
    const int set = limit;
    return set > 0 ? set : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void run_parallel(std::size_t count, const std::function<void(std::size_t)>& work) {
    const bool is_alone = count <= 1 || is_in_loop;
    const std::size_t threads = is_alone ? 1 : std::min(count, static_cast<std::size_t>(thread_limit()));
    Numbers numbers(count, work);
    {
        std::vector<std::jthread> others;
        others.reserve(threads - 1);
        try {
            while (others.size() + 1 < threads) others.emplace_back([&numbers] { numbers.work(); });
        } catch (const std::system_error&) {  // the system allows no more threads; those that are there do the work
        }
        numbers.work();
    }
    numbers.pass_on_failure();
}

}  // namespace tandem
