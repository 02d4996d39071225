#include "swiftlet/ground/fleet/order_sender.hpp"

#include <chrono>
#include <utility>

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;
using Request = OrderExecution::Request;

constexpr auto kAnswerTimeout = 500ms;
constexpr double kAsideSpeed = 0.8;  // m/s

}  // namespace

OrderSender::OrderSender(const std::shared_ptr<Client>& client, io::Progress& progress,
                         std::function<bool()> gives_up)
    : client_(*client), vehicle_(client), progress_(progress), gives_up_(std::move(gives_up)) {
  vehicle_.cancel_when([this] { return is_cancelled(); });
  thread_ = std::thread([this] { run(); });
}

OrderSender::~OrderSender() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void OrderSender::give(const Order& order, const std::string& because_of) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    order_ = order;
    because_of_ = because_of;
    is_new_ = true;
  }
  changed_.notify_one();
}

void OrderSender::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_new_ || ends_; });
    if (ends_) return;
    is_new_ = false;
    const Order order = order_;
    const std::string because_of = because_of_;
    lock.unlock();
    carry_out(order, because_of);
    lock.lock();
  }
}

bool OrderSender::is_cancelled() {
  if (gives_up_()) return true;
  const std::lock_guard<std::mutex> lock(mutex_);
  return ends_;
}

// An order may have waited while the flight was abandoned.
void OrderSender::carry_out(const Order& order, const std::string& because_of) {
  if (is_cancelled()) return;
  const View view = client_.view();
  const MissionNews news = mission_news(view.control.message, view.mission.message, client_.mission_id());
  const Request request = execution_.next(order, news, own_client_);
  if (request != Request::kNone) {
    const Result answer = send(request, order);
    if (answer.key.client != 0) own_client_ = answer.key.client;
    if (!answer.accepted()) return;
    execution_.accepted(request, order);
  }
  say(order, because_of);
}

Result OrderSender::send(Request request, const Order& order) {
  if (request == Request::kGoTo)
    return vehicle_.go_to({order.place_ned, std::nullopt, kAsideSpeed}, kAnswerTimeout).answer();
  const std::uint64_t mission = vehicle_.uploaded_id();
  if (request == Request::kPause) return vehicle_.pause_mission(mission, kAnswerTimeout).answer();
  return vehicle_.resume_mission(mission, kAnswerTimeout).answer();
}

void OrderSender::say(const Order& order, const std::string& because_of) {
  if (order.kind == said_) return;
  said_ = order.kind;
  if (order.kind == Order::Kind::kPause) progress_.say("waits for " + because_of);
  if (order.kind == Order::Kind::kStepAside) progress_.say("steps aside for " + because_of);
  if (order.kind == Order::Kind::kFly)
    progress_.say(execution_.is_of_others() ? "could go on, but was paused by someone else" : "goes on");
}

}  // namespace swiftlet::ground
