#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace slipway::fuzz {

// Makes new inputs of old ones. The same seed and the same calls give the same inputs.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  // Remembers the words of an input (names, numbers, quoted texts), to put them into others.
  void learn(std::string_view input);

  // One to eight changes to an input; `other` is one to take pieces from.
  std::string mutate(std::string input, std::string_view other, std::size_t most_bytes);

  std::size_t below(std::size_t end) { return end == 0 ? 0 : static_cast<std::size_t>(random_() % end); }

 private:
  void change_bytes(std::string& input);
  void change_piece(std::string& input, std::string_view other);
  void change_word(std::string& input);
  void nest(std::string& input);
  std::string_view word();

  std::mt19937_64 random_;
  std::vector<std::string> words_;
};

}  // namespace slipway::fuzz
