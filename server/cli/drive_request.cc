#include "server/cli/drive_request.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "api/requests/plan_request.h"
#include "server/cli/command_parts.h"
#include "server/cli/terminal/interruption.h"

namespace slipway::server {
namespace {

using api::json::Writer;

// Closes a file that was opened here; standard input is left open.
class Input {
 public:
  explicit Input(const std::string& path)
      : own_(path != "-"), descriptor_(own_ ? ::open(path.c_str(), O_RDONLY | O_CLOEXEC) : STDIN_FILENO) {}
  ~Input() {
    if (own_ && descriptor_ >= 0) ::close(descriptor_);
  }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  bool own_;
  int descriptor_;
};

}  // namespace

void write_place(Writer& w, const PlaceOption& place) {
  w.begin_object().exact("x_m", place.x_m).exact("y_m", place.y_m);
  if (place.yaw_deg) w.exact("yaw_deg", *place.yaw_deg);
  w.end_object();
}

void write_drive(Writer& w, const DriveOptions& drive) {
  w.text("terrain", drive.terrain).text("rover", drive.rover);
  if (drive.max_slip || drive.max_tilt_deg) {
    w.key("limits").begin_object();
    if (drive.max_slip) w.exact("max_slip", *drive.max_slip);
    if (drive.max_tilt_deg) w.exact("max_tilt_deg", *drive.max_tilt_deg);
    w.end_object();
  }
  if (drive.slip_check_every_m)
    w.key("checks").begin_object().exact("slip_check_every_m", *drive.slip_check_every_m).end_object();
  if (drive.max_embedding || drive.max_expected_stops) {
    w.key("bars").begin_object();
    if (drive.max_embedding) w.exact("max_embedding", *drive.max_embedding);
    if (drive.max_expected_stops) w.exact("max_expected_stops", *drive.max_expected_stops);
    w.end_object();
  }
  if (!drive.effects.empty()) {
    w.key("effects").begin_array();
    for (const std::string& effect : drive.effects) write_effect(w, effect);
    w.end_array();
  }
  if (!drive.failed.empty()) {
    w.key("failed_wheels").begin_object();
    for (const std::string& failed : drive.failed) write_setting(w, failed);
    w.end_object();
  }
  if (!drive.legend.empty()) w.text("legend", drive.legend);
  if (drive.as_of_sol) w.whole("as_of_sol", *drive.as_of_sol);
  if (drive.draws) w.whole("draws", *drive.draws);
  if (drive.seed) w.whole("seed", *drive.seed);
  if (drive.speed_m_s) w.exact("speed_m_s", *drive.speed_m_s);
  if (drive.motor_temp_c) w.exact("motor_temp_c", *drive.motor_temp_c);
}

Result<std::string> read_request(const std::string& path) {
  const Input input(path);
  if (input.descriptor() < 0)
    return fail(ErrorCode::kUnreadableData,
                fmt::format("cannot open {}: {}", path, std::system_category().message(errno)));
  std::string text;
  std::array<char, 65536> piece{};
  constexpr int kLook_ms = 100;
  while (!given_up()) {
    // A read of a terminal or a pipe would go on through an interruption: it is begun when there is something
    // to read.
    pollfd waiting{input.descriptor(), POLLIN, 0};
    if (::poll(&waiting, 1, kLook_ms) <= 0) continue;
    const ssize_t count = ::read(input.descriptor(), piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0)
      return fail(ErrorCode::kUnreadableData,
                  fmt::format("cannot read {}: {}", path, std::system_category().message(errno)));
    if (count == 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(count));
    if (text.size() > api::RequestLimits::kBodyBytes)
      return fail(ErrorCode::kPayloadTooLarge,
                  fmt::format("a request has at most {} bytes", api::RequestLimits::kBodyBytes));
  }
  return fail(ErrorCode::kCancelled, "the question was given up before it was read");
}

}  // namespace slipway::server
