// Tests of the conditions under which options have an effect. Every condition that a command declares is checked.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "tests/app/program.h"

namespace retrace::test::option_needs_test {
namespace {

/// Returns the name of an argument: the last name of an option, or the word of a positional argument.
std::string name_of(const Json& argument) {
  return argument["names"].empty() ? argument["value"] : argument["names"].back();
}

/// Builds a valid command line from the declarations of a command in the output of `retrace manual`.
class Line {
 public:
  Line(const Json& manual, const Json& command) : command_(command) {
    for (const Json& arguments : {command["arguments"], manual["arguments"]})
      for (const Json& argument : arguments) arguments_[name_of(argument)] = argument;
    const std::string synopsis = command["synopsis"];
    for (const auto& [name, argument] : arguments_) {
      const bool is_required = argument["names"].empty() ? synopsis.find("[" + name + "]") == std::string::npos
                                                         : argument.contains("required");
      if (is_required) give(name);
    }
  }

  void give(const std::string& name) {
    const Json& argument = arguments_.at(name);
    const std::string word = argument["value"];
    given_[name] = word.empty()                 ? ""
                   : argument["names"].empty()  ? "missing.toml"
                   : argument.contains("words") ? argument["words"].front().get<std::string>()
                                                : "1";
  }

  /// Adds options that violate the requirement. satisfy() must not make this requirement hold again.
  void violate(const Json& need) {
    for (const Json& condition : need) {
      const std::string option = condition["option"];
      forbidden_.insert(condition);
      if (condition.contains("values")) {
        const Json& values = condition["values"];
        for (const Json& word : arguments_.at(option)["words"])
          if (std::count(values.begin(), values.end(), word) == 0) given_[option] = word;
      } else if (!condition["given"].get<bool>()) {
        give(option);
      }
    }
  }

  /// Adds options until the requirements of all given options are met.
  /// \param but requirement that remains violated; null if all requirements must be met
  void satisfy(const Json& but) {
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& [name, value] : std::map(given_))
        if (arguments_.at(name).contains("needs"))
          for (const Json& need : arguments_.at(name)["needs"])
            if (need != but && !holds(need)) changed = make_hold(need) || changed;
    }
  }

  Arguments arguments() const {
    Arguments all = {command_["name"]};
    for (const auto& [name, value] : given_)
      all.push_back(!name.starts_with('-') ? value : value.empty() ? name : name + "=" + value);
    return all;
  }

 private:
  bool holds(const Json& need) const {
    return std::any_of(need.begin(), need.end(), [&](const Json& condition) {
      const std::string option = condition["option"];
      const bool is_given = given_.contains(option);
      if (!condition.contains("values")) return is_given == condition["given"].get<bool>();
      const Json value = is_given ? Json(given_.at(option)) : arguments_.at(option)["default"];
      const Json& values = condition["values"];
      return std::count(values.begin(), values.end(), value) > 0;
    });
  }

  /// Adds options that meet a requirement.
  /// \return false if other conditions exclude all such options
  bool make_hold(const Json& need) {
    for (const Json& condition : need) {
      const std::string option = condition["option"];
      if (forbidden_.contains(condition)) continue;
      if (condition.contains("values")) {
        if (given_.contains(option)) continue;
        given_[option] = condition["values"].front();
        return true;
      }
      if (!condition["given"].get<bool>()) continue;
      give(option);
      return true;
    }
    ADD_FAILURE() << "no command line meets " << need;
    return false;
  }

  const Json& command_;
  std::map<std::string, Json> arguments_;
  std::map<std::string, std::string> given_;
  std::set<Json> forbidden_;
};

std::string text_of(const Arguments& arguments) {
  std::string text;
  for (const std::string& word : arguments) text += word + " ";
  return text;
}

/// Runs each command with each requirement met, and with each requirement violated. The design files do not exist. If
/// retrace accepts the options, it therefore reports a missing file.
TEST(OptionNeeds, AreCheckedForEveryOptionOfEveryCommand) {
  const TemporaryFolder folder;
  const Json manual = retrace_json(folder, {"manual"});
  std::set<std::string> checked;
  for (const Json& command : manual["commands"])
    for (const Json& argument : command["arguments"]) {
      if (!argument.contains("needs")) continue;
      const std::string option = name_of(argument);
      checked.insert(command["name"].get<std::string>() + " " + option);
      const auto run = [&](const Json& violated) {
        Line line(manual, command);
        line.give(option);
        line.violate(violated);
        line.satisfy(violated);
        SCOPED_TRACE(text_of(line.arguments()));
        const Outcome outcome = retrace(folder, line.arguments());
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        // The message may name any option that has the violated requirement, not only the tested one.
        const bool is_refused = std::ranges::any_of(command["arguments"], [&](const Json& other) {
          const bool has_need = other.contains("needs") && std::ranges::count(other["needs"], violated) > 0;
          const std::string begin = "retrace: " + name_of(other) + ": ";
          return has_need && (outcome.err.starts_with(begin + "requires ") ||
                              outcome.err.starts_with(begin + "not allowed together with "));
        });
        EXPECT_EQ(is_refused, !violated.empty()) << outcome.err;
        EXPECT_EQ(folder.names(), std::vector<std::string>{}) << "something was written";
      };
      run(Json::array());
      for (const Json& need : argument["needs"]) run(need);
    }
  for (const char* known :
       {"rre --samples", "rre --cutoff", "rre --far-field", "photometry --samples", "photometry --window-power",
        "image --cutoff", "image --false-colour", "rays --stokes", "sweep --resume", "calibrate --dialect"})
    EXPECT_EQ(checked.count(known), 1U) << known;
}

/// The engine `auto` may select any engine. It therefore accepts the options of all engines.
TEST(OptionNeeds, TheEngineAutoTakesTheOptionsOfAllEngines) {
  const TemporaryFolder folder;
  for (const Arguments& more : std::vector<Arguments>{
           {"rre", "--samples=5", "--cutoff=1e-6", "--sampling=plain"},
           {"rre", "--target-error=1e-3", "--cutoff=1e-6"},
           {"photometry", "--standard=r150", "--area-cm2=1", "--samples=5", "--cutoff=1e-3", "--window-power"},
           {"image", "--detector", "--samples=5", "--cutoff=1e-6"}}) {
    const Outcome outcome = retrace(folder, with(more, {"missing.toml", "--engine=auto"}));
    EXPECT_EQ(refused_at(outcome), "missing.toml");
  }
}

}  // namespace
}  // namespace retrace::test::option_needs_test
