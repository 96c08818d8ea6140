#pragma once

#include <deque>
#include <map>
#include <string>
#include <utility>

namespace slipway::server {

// What waits, by whom it is for: each has a turn after the other, however much one of them asks for. What is
// for the same one keeps its order.
template <class Item>
class FairQueue {
 public:
  void push(const std::string& whose, Item item) {
    std::deque<Item>& of_it = waiting_[whose];
    if (of_it.empty()) turns_.push_back(whose);
    of_it.push_back(std::move(item));
  }
  bool empty() const { return turns_.empty(); }
  // Not of an empty queue.
  Item pop() {
    const auto turn = waiting_.find(turns_.front());
    turns_.pop_front();
    Item item = std::move(turn->second.front());
    turn->second.pop_front();
    if (turn->second.empty())
      waiting_.erase(turn);
    else
      turns_.push_back(turn->first);
    return item;
  }

 private:
  std::map<std::string, std::deque<Item>> waiting_;  // none is empty
  std::deque<std::string> turns_;                    // each that is in waiting_ once
};

}  // namespace slipway::server
