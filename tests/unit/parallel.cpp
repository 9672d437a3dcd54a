#include "support/catch.hpp"

#include "levelray/core/parallel.hpp"

#include <atomic>
#include <chrono>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

using namespace levelray;

TEST_CASE("parallel loops cover every index once, in chunks that do not depend on the threads") {
  for (const std::size_t count : {0u, 1u, 7u, 64u, 1001u})
    for (const std::size_t grain : {1u, 3u, 64u, 5000u}) {
      std::vector<std::pair<std::size_t, std::size_t>> reference;
      for (const int threads : {1, 2, 7}) {
        CAPTURE(count, grain, threads);
        const ThreadLimit limit(threads);
        std::vector<int> visits(count, 0);
        std::vector<std::size_t> chunk_end(count + 1, 0); // written at its begin, by one chunk each
        parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
          chunk_end[begin] = end;
          for (std::size_t i = begin; i != end; ++i) ++visits[i];
        });
        CHECK(visits == std::vector<int>(count, 1));
        std::vector<std::pair<std::size_t, std::size_t>> chunks;
        for (std::size_t i = 0; i != count; ++i)
          if (chunk_end[i] != 0) {
            CHECK(chunk_end[i] - i <= grain);
            chunks.emplace_back(i, chunk_end[i]);
          }
        if (threads == 1) reference = chunks;
        CHECK(chunks == reference);
      }
    }
}

TEST_CASE("more threads than cores take part when they are asked for, and one when one is") {
  for (const int threads : {1, 7}) {
    const ThreadLimit limit(threads);
    std::mutex mutex;
    std::set<std::thread::id> seen;
    // Chunks wait until all threads have come, or for long: a starved machine may lack some, never have
    // more.
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    parallel_for(200, 1, [&](std::size_t, std::size_t) {
      for (bool all = false; !all && std::chrono::steady_clock::now() < deadline;) {
        const std::lock_guard lock(mutex);
        seen.insert(std::this_thread::get_id());
        all = seen.size() >= static_cast<std::size_t>(threads);
      }
    });
    if (threads == 1)
      CHECK(seen.size() == 1);
    else
      CHECK((seen.size() > 2 && seen.size() <= 7));
  }
}

TEST_CASE("what one parallel loop wrote the next one and the caller may read") {
  // Nothing but the loops orders these accesses: the thread sanitizer's run shows that they suffice.
  const ThreadLimit limit(4);
  std::vector<std::uint64_t> values(10000, 1), sums(100, 0);
  for (int round = 0; round != 20; ++round) {
    parallel_for(values.size(), 10, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i != end; ++i) values[i] += i;
    });
    parallel_for(sums.size(), 1, [&](std::size_t begin, std::size_t) {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(100 * begin);
      sums[begin] = std::accumulate(first, first + 100, std::uint64_t{0});
    });
  }
  // Each value i became 1 + 20 i; the sum over i < 10000 is 10000 + 20 * 9999 * 10000 / 2.
  CHECK(std::accumulate(sums.begin(), sums.end(), std::uint64_t{0}) == 10000u + 999900000u);
}

TEST_CASE("the exception of a loop's body reaches the caller") {
  CHECK_THROWS_AS(parallel_for(100, 1,
                               [](std::size_t begin, std::size_t) {
                                 if (begin == 57) throw std::runtime_error("57");
                               }),
                  std::runtime_error);
}

TEST_CASE("thread limits nest and end with their scopes") {
  const int before = thread_count();
  {
    const ThreadLimit outer(2);
    CHECK(thread_count() == 2);
    {
      const ThreadLimit inner(1);
      CHECK(thread_count() == 1);
    }
    CHECK(thread_count() == 2);
  }
  CHECK(thread_count() == before);
}
