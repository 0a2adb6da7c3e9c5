#include "net/load.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "net/load_viewer.h"
#include "net/resolve.h"

namespace weft::net {

namespace asio = boost::asio;
using Clock = std::chrono::steady_clock;

namespace {

/// So many viewers may be joining at a time.
constexpr int kJoining = 32;

double own_cpu() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

/// Viewer `i` of `count` is at the distance whose share of the mix it falls into.
double distance_of(const LoadPlan& plan, int i) {
  const double place = (i + 0.5) / plan.viewers;
  if (place < plan.mix[0]) return plan.distances[0];
  return place < plan.mix[0] + plan.mix[1] ? plan.distances[1] : plan.distances[2];
}

}  // namespace

std::size_t make_room_for_connections() {
  constexpr rlim_t kOthers = 32;  // standard streams, event loop
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return 0;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
  return getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur > kOthers ? limit.rlim_cur - kOthers : 0;
}

double LoadResult::age(double percent) const {
  if (ages.empty()) return 0;
  const auto last = static_cast<double>(ages.size() - 1);
  return ages[static_cast<std::size_t>(std::lround(last * percent / 100))];
}

LoadResult load(const Url& url, const LoadPlan& plan, const ClientSecurity& security,
                const std::function<void()>& joined) {
  asio::io_context io{1};
  TlsContext tls;
  try {
    if (url.secure) tls = client_tls(security.authorities);
  } catch (const std::runtime_error& error) {
    throw ConnectionError(error.what());
  }
  const auto where = resolve(io, url);
  LoadTally tally;
  std::vector<std::shared_ptr<LoadViewer>> viewers;
  const int stride = plan.slow > 0 ? std::max(1, static_cast<int>(std::lround(1 / plan.slow))) : 0;
  const auto begun_at = Clock::now(), until = begun_at + LoadViewer::kJoinTime;
  while (tally.settled < plan.viewers && Clock::now() < until) {
    const auto begun = static_cast<int>(viewers.size());
    if (begun < plan.viewers && begun - tally.settled < kJoining) {
      const LoadViewer::Manner manner{distance_of(plan, begun), plan.rate, stride > 0 && begun % stride == 0};
      viewers.push_back(std::make_shared<LoadViewer>(io, url, security, tls, manner, tally));
      viewers.back()->join(where);
    } else {
      io.run_one_for(std::chrono::milliseconds(10));
    }
    if (io.stopped()) io.restart();  // it stops when nobody has anything to do
    // Not all that is ready: frames may come faster than they are taken, and others are to join still.
    for (int taken = 0; taken < kJoining && io.poll_one() > 0; ++taken) continue;
  }
  if (tally.joined == 0)
    throw ConnectionError("no viewer could join at " + host_header(url) + ": " +
                          (tally.failures.empty() ? "no frame came" : tally.failures.front()));
  // Of those who have not answered at all.
  for (int missing = tally.settled; missing < plan.viewers; ++missing)
    tally.failures.emplace_back("no frame came in " + std::to_string(LoadViewer::kJoinTime.count()) + " s");
  LoadResult result;
  result.joined = tally.joined;
  result.joining = std::chrono::duration<double>(Clock::now() - begun_at).count();
  joined();
  const double cpu = own_cpu();
  const auto start = Clock::now();
  tally.measuring = true;
  io.run_for(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(plan.seconds)));
  tally.measuring = false;
  result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  result.own_cpu = own_cpu() - cpu;
  result.failures = std::move(tally.failures);
  result.frames = tally.frames;
  result.bytes = tally.bytes;
  result.ages = std::move(tally.ages);
  std::sort(result.ages.begin(), result.ages.end());
  bool first = true;
  for (const auto& viewer : viewers) {
    if (!viewer->slow() && viewer->joined()) {
      const double rate = static_cast<double>(viewer->frames()) / result.seconds;
      result.fewest = first ? rate : std::min(result.fewest, rate);
      result.most = std::max(result.most, rate);
      first = false;
    }
    viewer->leave();
  }
  io.run_for(std::chrono::seconds(1));
  return result;
}

}  // namespace weft::net
