// Sends the orders of the fleet's monitor to one vehicle, from a thread of its own.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/ground/fleet/order_execution.hpp"
#include "swiftlet/io/command_line/progress.hpp"

namespace swiftlet::ground {

class OrderSender {
 public:
  // progress outlives this object. gives_up: true from when nothing is to be sent any more; from any thread.
  OrderSender(const std::shared_ptr<Client>& client, io::Progress& progress, std::function<bool()> gives_up);
  // Ends at once, also while a request is not answered.
  ~OrderSender();
  OrderSender(const OrderSender&) = delete;
  OrderSender& operator=(const OrderSender&) = delete;

  // Does not wait. The newest order counts; it is asked for again until it is accepted. because_of: name of the other vehicle.
  void give(const Order& order, const std::string& because_of);

 private:
  void run();
  void carry_out(const Order& order, const std::string& because_of);
  Result send(OrderExecution::Request request, const Order& order);
  bool is_cancelled();
  void say(const Order& order, const std::string& because_of);

  const Client& client_;
  Vehicle vehicle_;  // on the client
  io::Progress& progress_;
  const std::function<bool()> gives_up_;
  OrderExecution execution_;  // of the thread, as those below
  std::optional<std::uint64_t> own_client_;
  Order::Kind said_ = Order::Kind::kFly;

  std::mutex mutex_;  // guards the four below
  std::condition_variable changed_;
  Order order_;
  std::string because_of_;
  bool is_new_ = false;
  bool ends_ = false;
  std::thread thread_;  // last
};

}  // namespace swiftlet::ground
