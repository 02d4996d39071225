// Logs of PX4: ULog, version 1 (docs.px4.io, "ULog File Format"). Reads the logged values of chosen fields.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace swiftlet::ulog {

// The values of some fields of a topic, as logged: a row for each message.
struct Table {
  std::vector<double> time_s;                // of each row, since PX4 was started; rises
  std::vector<std::vector<double>> columns;  // in the order of the fields asked for
  std::size_t rows() const { return time_s.size(); }
};

// Data that was lost, between the stamps of two messages.
struct Loss {
  std::size_t at = 0;     // the byte of the file at which what is not understood begins
  std::size_t bytes = 0;  // of the file; 0: the logger of PX4 says that it could not write in that time
  double from_s = 0.0;
  double until_s = 0.0;
};

class Log {
 public:
  // Refers to the bytes, which must outlive it. Throws ConfigError if they are no ULog, a definition is not understood or
  // data is used that the file marks as incompatible. A file that ends within a message, as after a loss of power, is read up
  // to there, and so is the part before data that was appended to it, as after a crash. What is not understood within the file, such
  // as a sector of zeros, is left out with the message before it, which may be spoiled too. file_name appears in messages only.
  Log(std::string_view bytes, std::string file_name);

  // True if the topic was logged, by its first instance.
  bool has(const std::string& topic) const;
  // fields: such as "z" or "xyz[2]". Messages whose stamp is not above the last are left out. Throws ConfigError naming topic
  // or field if one was not logged, or is no number.
  Table read(const std::string& topic, const std::vector<std::string>& fields) const;
  // The value when the log began; throws ConfigError if there is none.
  double parameter(const std::string& name) const;
  bool ends_early() const { return ends_early_; }
  const std::vector<Loss>& losses() const { return losses_; }

 private:
  struct Field {
    std::string type;       // of PX4: "float", or that of a nested message
    std::size_t count = 1;  // of an array
    std::string name;
  };
  struct Place {  // of a value in a message
    char type = 0;
    std::size_t offset = 0;
  };
  using Places = std::map<std::string, Place>;
  struct Data {
    std::uint16_t subscription = 0;
    std::string_view fields;
  };
  struct Layout {  // of the messages of a subscription
    std::size_t size = 0;
    std::size_t stamp = 0;  // its offset
  };

  void read_messages();
  // The first byte behind `at` at which messages begin again; none: `end`.
  std::size_t next_messages(std::size_t at, std::size_t end);
  bool begins_messages(std::size_t at, std::size_t end) const;
  void lay_out_subscriptions();
  double stamp_s(const Data& data) const;
  void note_data(std::string_view message);
  void note_loss(std::size_t at, std::size_t bytes);
  void note_dropout(std::string_view message);
  void read_flags(std::string_view message, std::size_t next);
  void read_definition(char type, std::string_view message);
  void read_format(std::string_view text);
  void read_parameter(std::string_view message);
  void read_subscription(std::string_view message);
  std::size_t lay_out(const std::string& format, const std::string& prefix, std::size_t offset, int depth,
                      Places& places) const;
  [[noreturn]] void fail(const std::string& what) const;

  std::string_view bytes_;
  std::string file_name_;
  std::map<std::string, std::vector<Field>> formats_;
  std::map<std::string, std::uint16_t> topics_;         // first instances
  std::map<std::uint16_t, std::string> subscriptions_;  // all instances
  std::map<std::uint16_t, Layout> layouts_;
  std::map<std::uint16_t, std::vector<std::string_view>> data_;  // messages of each subscription
  std::map<std::string, double> parameters_;
  std::vector<std::size_t> appended_;  // offsets in the file at which sections begin, rising
  bool ends_early_ = false;
  std::vector<Loss> losses_;
  std::optional<Data> last_;      // if it stands directly before what is read
  std::optional<Data> before_;    // the last one, but for last_
  bool loss_has_no_end_ = false;  // the last one: no message has followed it yet
};

}  // namespace swiftlet::ulog
