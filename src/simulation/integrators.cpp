// The table of integrators: a new one is an enumerator, a row here and its code.
#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include "relaxation/implicit_euler.h"
#include "spherical_springs/integrator.h"
#include "spherical_springs/range.h"
#include "stepping/blocked_splitting.h"

namespace spherical_springs::core {
namespace {

using Make = std::unique_ptr<Integrator> (*)(const std::shared_ptr<const Plan>&, double time_step);

struct Entry {
  IntegrationMethod method;
  const char* name;
  int order;
  double stability_limit;  // of frequency times step
  bool takes_energy_out;
  Make make;
};

template <IntegrationMethod method>
Entry splitting(const char* name) {
  const SplittingScheme& scheme = splittingScheme(method);
  const auto make = [](const std::shared_ptr<const Plan>& plan, double time_step) {
    return std::unique_ptr<Integrator>(
        std::make_unique<BlockedSplitting>(plan, splittingScheme(method), time_step));
  };
  return {method, name, scheme.order, scheme.stability_limit, false, make};
}

Entry implicitEuler() {
  const auto make = [](const std::shared_ptr<const Plan>& plan, double time_step) {
    return std::unique_ptr<Integrator>(std::make_unique<ImplicitEuler>(plan->system(), time_step));
  };
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  return {IntegrationMethod::implicit_euler, "implicit_euler", 1, kUnlimited, true, make};
}

const auto& table() {
  static const std::array kTable = {
      splitting<IntegrationMethod::euler>("euler"), splitting<IntegrationMethod::verlet>("verlet"),
      splitting<IntegrationMethod::fourth_order>("fourth_order"), implicitEuler()};
  return kTable;
}

const Entry& entryOf(IntegrationMethod method) {
  return *std::find_if(table().begin(), table().end(),
                       [&](const Entry& entry) { return entry.method == method; });
}

}  // namespace

IntegrationMethod integrationMethod(const std::string& name) {
  std::string names;
  for (const Entry& entry : table()) {
    if (name == entry.name) return entry.method;
    names += std::string(names.empty() ? "" : ", ") + entry.name;
  }
  throw std::invalid_argument("integrator is " + quoted(name) + "; allowed: " + names);
}

const char* nameOf(IntegrationMethod method) { return entryOf(method).name; }

int orderOf(IntegrationMethod method) { return entryOf(method).order; }

double stabilityLimit(IntegrationMethod method) { return entryOf(method).stability_limit; }

bool takesEnergyOut(IntegrationMethod method) { return entryOf(method).takes_energy_out; }

std::unique_ptr<Integrator> makeIntegrator(const std::shared_ptr<const Plan>& plan,
                                           IntegrationMethod method, double time_step) {
  return entryOf(method).make(plan, time_step);
}

}  // namespace spherical_springs::core
