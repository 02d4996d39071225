#include "swiftlet/ground/vehicle_check/checks.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/args.h>
#include <fmt/format.h>

namespace swiftlet::ground {

CheckResult judge(const Check& check, double value, const Words& words) {
  if (value >= check.least && value <= check.most) return judge_by(check, value, "", words);
  const auto* const found =
      std::find_if(std::begin(check.sentences), std::end(check.sentences),
                   [&](const Sentence& sentence) { return !(value < sentence.from || value > sentence.to); });
  return judge_by(check, value, found->text, words);
}

CheckResult judge_by(const Check& check, double value, const std::string& sentence, const Words& words) {
  fmt::dynamic_format_arg_store<fmt::format_context> known;
  known.push_back(fmt::arg("value", value));
  known.push_back(fmt::arg("size", std::abs(value)));
  known.push_back(fmt::arg("least", check.least));
  known.push_back(fmt::arg("most", check.most));
  for (const Word& word : words) {
    if (word.is_text) {
      known.push_back(fmt::arg(word.name, word.text));
    } else {
      known.push_back(fmt::arg(word.name, word.number));
    }
  }
  const auto say = [&](const std::string& text) { return fmt::vformat(text, known); };
  return {say(check.name), sentence.empty() ? Verdict::kPass : Verdict::kFail,
          Figure{value, check.unit, say(check.figure)}, say(check.limit), say(sentence)};
}

}  // namespace swiftlet::ground
