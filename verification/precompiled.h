// Headers that most translation units of the verification need, compiled once.
#include "continuum/precompiled.h"

#include <Eigen/Dense>
#include <deal.II/base/function_parser.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <variant>
#include <vector>
