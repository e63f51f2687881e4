#include "relaxation/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace spherical_springs::core {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLongestMove = 0.7;  // of a particle in one step [rad]
constexpr double kLeastShift = 1e-7;  // rotations of the whole scene need one
constexpr double kGreatestShift = 1e3;
constexpr double kPoor = 0.25, kGood = 0.75;  // drop of the energy, of that of the model

/// Judges the pace by a drop of the energy and the one before it.
Pace paceOf(double drop, double earlier) {
  if (drop < 5e-3 * earlier) return Pace::near_end;
  return drop < 0.25 * earlier || drop > earlier ? Pace::good : Pace::poor;
}

}  // namespace

Newton::Newton(const System& system, const Points& positions, Eigen::VectorXd inertia)
    : threads_(system.threads()),
      energy_(system, positions, std::move(inertia)),
      solver_(energy_.pattern(), threads_) {}

void Newton::aimAt(const TorqueLimit* limit) {
  limit_ = limit;
  excess_ = kInfinity;
  const bool placed = scale_.size() > 0 || energy_.freeCount() == 0;
  if (limit_ && placed) measureExcess();
}

void Newton::place(const Points& positions) {
  energy_.place(positions);
  model_ = Model::definite;
  forgetSteps();
  scale_.setZero(energy_.freeCount());
  evaluate();
}

void Newton::goOn(const System& system, const Points& positions) {
  energy_.take(system);
  energy_.carry(positions);
  forgetSteps();
  evaluate();
}

void Newton::forgetSteps() {
  shift_ = kLeastShift;
  radius_ = kInfinity;
  hold_.setZero(energy_.freeCount());
  iterations_ = calm_iterations_ = 0;
  creeping_ = false;
  earlier_drop_ = 0;
  pace_ = Pace::good;
}

/// Energy, gradient and the Hessian that the model asks for.
void Newton::evaluate() {
  constexpr double kLeastShare = 1e-12;
  if (model_ == Model::definite || model_ == Model::indefinite) {
    energy_.evaluate(Curvature::definite);
    parallelFor(scale_.size(), threads_, [&](std::ptrdiff_t i) {
      const auto& block = energy_.hessian()[energy_.pattern().diagonal[i]];
      scale_[i] = std::max(scale_[i], 0.5 * block.trace());
    });
    const double largest = scale_.size() > 0 ? scale_.maxCoeff() : 0;
    scale_ = scale_.cwiseMax(largest > 0 ? kLeastShare * largest : 1);
  }
  if (model_ == Model::indefinite) definite_ = energy_.hessian();
  if (model_ == Model::tempered) energy_.evaluate(Curvature::tempered);
  if (model_ == Model::exact || model_ == Model::indefinite) energy_.evaluate(Curvature::exact);
  if (limit_) measureExcess();
}

/// Half the trace of the block of a free particle in the definite Hessian, where there is one, or
/// in the model's, whose trace is at most that.
double Newton::stiffnessAt(std::size_t free) const {
  const auto& blocks = model_ == Model::indefinite ? definite_ : energy_.hessian();
  return 0.5 * blocks[energy_.pattern().diagonal[free]].trace();
}

template <class Stiffness>
double Newton::largestExcess(const Stiffness& stiffness) const {
  return parallelLargest(energy_.freeCount(), threads_,
                         [&](std::ptrdiff_t i) { return excessAt(i, stiffness(i)); });
}

/// `stiffness`: in units of the energy, as the gradient.
double Newton::excessAt(std::size_t free, double stiffness) const {
  const double unit = energy_.unit(free);
  const double torque = unit * energy_.gradient().segment<2>(2 * free).norm();
  const double felt = unit * std::max(stiffness, 0.);
  return excessOf(torque, limit_->allowed(energy_.particle(free), felt));
}

// Springs under pressure take from the trace of the exact Hessian. Where that alone is in the way,
// the definite one decides.
void Newton::measureExcess() {
  const auto by_model = [this](std::ptrdiff_t i) { return stiffnessAt(i); };
  excess_ = largestExcess(by_model);
  if (!limit_->isRelative() || excess_ <= 1) return;
  if (model_ != Model::exact && model_ != Model::tempered) return;
  if (largestExcess([this](std::ptrdiff_t i) { return scale_[i]; }) > 1) return;
  energy_.evaluate(Curvature::definite);
  excess_ = largestExcess(by_model);
  energy_.evaluate(model_ == Model::exact ? Curvature::exact : Curvature::tempered);
}

std::vector<bool> Newton::calm() const {
  std::vector<bool> calm(energy_.places().order().particles.size(), true);
  for (std::size_t i = 0; i < energy_.freeCount(); ++i) {
    calm[energy_.particle(i)] = excessAt(i, stiffnessAt(i)) <= 1;
  }
  return calm;
}

ModelMinimum Newton::minimum(const Eigen::VectorXd& gradient, double tolerance) {
  const auto* definite = model_ == Model::indefinite ? &definite_ : nullptr;
  const Eigen::VectorXd shifts = scale_.cwiseProduct((hold_.array() + shift_).matrix());
  return solver_.minimum(energy_, definite, shifts, scale_.cwiseInverse(), gradient, tolerance);
}

/// How much of the gradient a step may leave: little where earlier steps have left little, or where
/// the start is near an earlier end.
double Newton::tolerance() const {
  constexpr double kMost = 0.1, kNearEnd = 1e-2, kLeast = 1e-4;
  if (iterations_ == 0) return model_ == Model::exact ? kNearEnd : kMost;
  const double left = scaledGradient() / earlier_gradient_;
  const double enough = 0.3 / excess_;
  return std::clamp(std::max(0.9 * std::pow(left, 1.5), enough), kLeast, kMost);
}

double Newton::longestMove(const Eigen::VectorXd& step) const {
  return std::sqrt(parallelLargest(scale_.size(), threads_, [&](std::ptrdiff_t i) {
    return step.segment<2>(2 * i).squaredNorm();
  }));
}

double Newton::scaledLength(const Eigen::VectorXd& step) const {
  return std::sqrt(parallelSum(scale_.size(), threads_, [&](std::ptrdiff_t i) {
    return scale_[i] * step.segment<2>(2 * i).squaredNorm();
  }));
}

/// Over the stiffness, so that soft springs count as much as stiff ones.
double Newton::scaledGradient() const {
  return std::sqrt(parallelSum(scale_.size(), threads_, [&](std::ptrdiff_t i) {
    return energy_.gradient().segment<2>(2 * i).squaredNorm() / (scale_[i] * scale_[i]);
  }));
}

/// Goes on from where conjugate gradients met negative curvature to the radius, no particle further
/// than its springs reach; after T. Steihaug, SIAM J. Numer. Anal. 20 (1983).
void Newton::goDownward(ModelMinimum& minimum) const {
  const Eigen::VectorXd reach = energy_.reach();
  double length = kLongestMove / longestMove(minimum.downward);
  for (Eigen::Index i = 0; i < reach.size(); ++i) {
    length = std::min(length, reach[i] / minimum.downward.segment<2>(2 * i).norm());
  }
  if (radius_ < kInfinity) {
    const double room = std::pow(radius_, 2) - std::pow(scaledLength(minimum.step), 2);
    length = std::min(length, std::sqrt(std::max(room, 0.)) / scaledLength(minimum.downward));
  }
  minimum.step += length * minimum.downward;
}

void Newton::keepInside(Eigen::VectorXd& step) {
  step *= std::min({1., radius_ / scaledLength(step), kLongestMove / longestMove(step)});
  if (guard_) step *= allowedShare(step);
}

/// Returns the share of a step that the guard allows. Particles that it holds back are made to
/// resist, so that the next steps go round them.
double Newton::allowedShare(const Eigen::VectorXd& step) {
  constexpr double kEase = 0.5;
  const Points positions = energy_.places().positions();
  Eigen::VectorXd hold = Eigen::VectorXd::Zero(positions.cols());
  const double share = guard_->allowedShare(positions, energy_.places().moves(step), hold);
  for (Eigen::Index i = 0; i < hold_.size(); ++i) {
    hold_[i] = std::max(kEase * hold_[i], hold[energy_.particle(i)]);
  }
  return share;
}

bool Newton::iterate() {
  constexpr int kMostAttempts = 40;
  if (creeps()) return false;
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    ModelMinimum found = minimum(energy_.gradient(), tolerance());
    if (found.indefinite && (model_ == Model::tempered || model_ == Model::exact)) {
      model_ = model_ == Model::exact && pace_ == Pace::good ? Model::tempered : Model::indefinite;
      calm_iterations_ = 0;
      evaluate();
      continue;
    }
    if (found.indefinite && found.downward.size() == 0) {  // by rounding
      shift_ = std::max(10 * shift_, 1e-6);
      continue;
    }
    if (found.indefinite) goDownward(found);
    keepInside(found.step);
    const Trial trial = tryStep(found);
    if (trial != Trial::rejected) return trial == Trial::accepted;
  }
  return false;
}

Newton::Trial Newton::tryStep(const ModelMinimum& minimum) {
  const double value = energy_.value();
  const double gradient = scaledGradient();
  const double expected = energy_.expectedDrop(minimum.step);
  const double length = scaledLength(minimum.step);
  // Where the energy cannot resolve the drop any more, the gradient still can.
  const bool resolved = expected > kEnergyRounding * value;
  const Model model = model_;

  chooseModel(minimum);
  energy_.mark();
  energy_.move(minimum.step);
  evaluate();
  const double ratio = (value - energy_.value()) / expected;
  if (resolved && ratio < kPoor) correct();

  const double drop = value - energy_.value();
  const bool better = resolved ? drop > 1e-4 * expected
                               : drop > -kEnergyRounding * value && scaledGradient() < gradient;
  if (better) {
    if (!resolved || ratio > kGood) {
      shift_ = std::max(shift_ / 4, kLeastShift);
      radius_ = std::max(radius_, 2 * length);
    } else if (ratio < kPoor) {
      shift_ = std::min(4 * shift_, kGreatestShift);
      radius_ = length / 2;
    }
    earlier_gradient_ = gradient;
    pace_ = paceOf(drop, earlier_drop_);
    earlier_drop_ = drop;
    ++iterations_;
    return Trial::accepted;
  }
  energy_.goBack();
  model_ = model;
  evaluate();
  shift_ = std::max(4 * shift_, 1e-5);
  radius_ = length / 2;
  return resolved ? Trial::rejected : Trial::exhausted;
}

/// Chooses the model of the next step, whose Hessian is computed along with the gradient.
void Newton::chooseModel(const ModelMinimum& minimum) {
  calm_iterations_ = minimum.indefinite ? 0 : calm_iterations_ + 1;
  if (minimum.indefinite) model_ = Model::indefinite;
  if (calm_iterations_ < 2) return;
  // The test for a minimum after the last step needs the exact Hessian.
  const bool last = minimum.residual * excess_ <= 1;
  const bool tempered = model_ == Model::tempered && pace_ == Pace::good && !last;
  model_ = model_ == Model::definite || tempered ? Model::tempered : Model::exact;
}

/// Another step from where one has led out of a narrow bent valley, as stiff springs make them
/// where soft ones, or none, hold the rest: stiff springs let go at once.
void Newton::correct() {
  const Model model = model_;
  ModelMinimum found = minimum(energy_.gradient(), 0.1);
  if (found.indefinite) return;
  keepInside(found.step);
  energy_.move(found.step);
  evaluate();
  model_ = model;
}

/// Returns whether 300 iterations have lowered the energy by less than 0.01 %, as on the way into a
/// place where the energy has no derivative.
bool Newton::creeps() {
  constexpr int kWindow = 300;
  constexpr double kNextToNothing = 1e-4;
  if (iterations_ % kWindow != 0) return false;
  creeping_ = iterations_ > 0 && energy_.value() > (1 - kNextToNothing) * earlier_value_;
  earlier_value_ = energy_.value();
  return creeping_;
}

const char* Newton::whyStuck() const {
  return creeping_ ? "300 iterations lowered the energy by less than 0.01 %"
                   : "no step lowers the energy";
}

}  // namespace spherical_springs::core
