// Conversion of gains, as a part of other messages.
#pragma once

#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/messages/wire.hpp"

namespace swiftlet::messages {

// Adds the fault of a gain that is not finite. name: of the field, in the sentence.
void check_gains(const char* name, const msg::ControlGains& gains, wire::Check& check);
control::ControlGains from_message(const msg::ControlGains& in);

}  // namespace swiftlet::messages
