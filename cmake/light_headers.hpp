// Precompiled headers of the libraries that run once a command, or seldom.
#pragma once

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "library_headers.hpp"
