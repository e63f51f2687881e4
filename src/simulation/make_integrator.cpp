#include "spherical_springs/integrator.h"

#include <limits>
#include <stdexcept>
#include <utility>

#include "stepping/blocked_splitting.h"
#include "relaxation/implicit_euler.h"
#include "spherical_springs/range.h"

namespace spherical_springs::core {

IntegrationMethod integrationMethod(const std::string& name) {
  if (name == "euler") return IntegrationMethod::euler;
  if (name == "verlet") return IntegrationMethod::verlet;
  if (name == "fourth_order") return IntegrationMethod::fourth_order;
  if (name == "implicit_euler") return IntegrationMethod::implicit_euler;
  throw std::invalid_argument("integrator is " + quoted(name) +
                              "; allowed: euler, verlet, fourth_order, implicit_euler");
}

int orderOf(IntegrationMethod method) {
  return method == IntegrationMethod::implicit_euler ? 1 : splittingScheme(method).order;
}

double stabilityLimit(IntegrationMethod method) {
  if (method == IntegrationMethod::implicit_euler) return std::numeric_limits<double>::infinity();
  return splittingScheme(method).stability_limit;
}

std::unique_ptr<Integrator> makeIntegrator(std::shared_ptr<const Plan> plan,
                                           IntegrationMethod method, double time_step) {
  if (method == IntegrationMethod::implicit_euler) {
    return std::make_unique<ImplicitEuler>(plan->system(), time_step);
  }
  return std::make_unique<BlockedSplitting>(std::move(plan), splittingScheme(method), time_step);
}

}  // namespace spherical_springs::core
