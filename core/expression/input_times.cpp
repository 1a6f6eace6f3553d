#include <momenta/core/expression/input_times.h>
#include <momenta/core/expression/jumps.h>
#include <momenta/core/expression/tape.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

constexpr int looks = 4096, most_whole_numbers = 1000;
/// Longest pause, in places, within one change.
constexpr int rest = 4;
/// Least second difference that counts, relative to the largest value.
constexpr double varies = 1e-9;

}  // namespace

void InputTimes::add_corner(double t) {
  if (t > t0_ && t < end_) times_.push_back(t);
}

void InputTimes::add_pulse(double from, double to) {
  constexpr int parts = 8;
  for (int i = 0; i <= parts; ++i) add_corner(from + (to - from) * i / parts);
}

void InputTimes::add_jump(double before, double behind) {
  const double apart = beside_jump();
  add_corner(before - apart);
  add_corner(behind + apart);
}

std::vector<double> InputTimes::all() const {
  std::vector<double> sorted = times_;
  std::sort(sorted.begin(), sorted.end());
  const auto same = [least = 0.5 * beside_jump()](double a, double b) { return b - a <= least; };
  sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());
  return sorted;
}

bool InputTimes::add_linear(const Expression& argument, bool jumps, bool whole) {
  const double span = end_ - t0_, low = argument({&t0_, 1}), high = argument({&end_, 1});
  const double size = std::max(std::abs(low), std::abs(high));
  for (const double part : {0.1, 0.37, 0.71}) {
    const double t = t0_ + part * span, linear = low + part * (high - low);
    if (!(std::abs(argument({&t, 1}) - linear) <= 1e-12 * size)) return false;
  }
  const double from = std::min(low, high), to = std::max(low, high);
  if (from == to) return true;
  if (whole && to - from > most_whole_numbers) return false;
  const double first = whole ? std::ceil(from) : 0, last = whole ? std::floor(to) : 0;
  for (double value = first; value <= last; ++value) {
    const double t = t0_ + span * (value - low) / (high - low);
    if (jumps)
      add_jump(t, t);
    else
      add_corner(t);
  }
  return true;
}

void InputTimes::add(const Expression& formula, int time,
                     const std::function<std::optional<double>(int)>& number) {
  using O = formula::Operation;
  const std::vector<formula::Instruction>& tape = formula.tape();
  enum class Takes : char { nothing, time_alone, more };
  std::vector<Takes> takes(tape.size(), Takes::nothing);
  std::vector<char> is_part(tape.size(), 1);  // part of a larger formula of the time alone
  formula::Tape inputs;                       // the tape with numbers for constant variables
  std::vector<int> place(tape.size());
  for (std::size_t i = 0; i < tape.size(); ++i) {
    formula::Instruction in = tape[i];
    const std::optional<double> known =
        in.operation == O::variable && in.a != time && number ? number(in.a) : std::nullopt;
    if (known) in = {O::number, -1, -1, -1, *known, nullptr};
    if (in.operation == O::variable) {
      takes[i] = in.a == time ? Takes::time_alone : Takes::more;
      in.a = 0;
    } else if (in.operation != O::number) {
      for (int* operand : {&in.a, &in.b, &in.c})
        if (*operand >= 0) {
          takes[i] = std::max(takes[i], takes[static_cast<std::size_t>(*operand)]);
          *operand = place[static_cast<std::size_t>(*operand)];
        }
    }
    place[i] = inputs.add(in);
  }
  const auto alone = [&](int i) {
    return i >= 0 && takes[static_cast<std::size_t>(i)] == Takes::time_alone;
  };
  for (std::size_t i = 0; i < tape.size(); ++i)
    if (takes[i] == Takes::more && tape[i].operation != O::variable)
      for (const int operand : {tape[i].a, tape[i].b, tape[i].c})
        if (alone(operand)) is_part[static_cast<std::size_t>(operand)] = 0;
  for (const int output : formula.outputs())
    if (alone(output)) is_part[static_cast<std::size_t>(output)] = 0;
  const auto value_at = [&](int i) { return Expression(inputs, std::span<const int>(&i, 1)); };
  for (std::size_t i = 0; i < tape.size(); ++i) {
    if (takes[i] != Takes::time_alone || tape[i].operation == O::variable) continue;
    const O o = tape[i].operation;
    const bool jumps = formula::jumps(o);
    bool is_known = false;
    if (jumps || formula::has_corner(o)) {
      const int a = place[static_cast<std::size_t>(tape[i].a)];
      const bool two = formula::operands_of(o) == 2;
      const int argument =
          two ? inputs.add(O::subtract, a, place[static_cast<std::size_t>(tape[i].b)]) : a;
      is_known = add_linear(value_at(argument), jumps, o == O::floor);
    }
    if (!is_known && (jumps || is_part[i] == 0)) {
      const Expression input = value_at(place[i]);
      add([&input](double t) { return input({&t, 1}); });
    }
  }
}

/// Adds what is between two places whose values differ: a jump, or eighths of the interval.
void InputTimes::add_change(const std::function<double(double)>& input, double from, double to,
                            double low, double high, double least) {
  const double change = std::abs(high - low);
  if (!(change > least)) return;
  double a = from, b = to;
  for (int i = 0; i < 60; ++i) {
    const double half = 0.5 * (a + b);
    if (!(a < half && half < b)) break;
    const double middle = input(half);
    const bool before = std::abs(middle - low) > std::abs(high - middle);
    (before ? b : a) = half;
    (before ? high : low) = middle;
  }
  if (std::abs(high - low) > 0.5 * change) return add_jump(a, b);
  add_pulse(from, to);
}

void InputTimes::add(const std::function<double(double)>& input) {
  std::vector<double> values(looks + 1);
  const auto time = [&](int i) { return t0_ + (end_ - t0_) * i / looks; };
  const auto value = [&](int i) { return values[static_cast<std::size_t>(i)]; };
  double largest = 0;
  for (int i = 0; i <= looks; ++i) {
    values[static_cast<std::size_t>(i)] = input(time(i));
    if (!std::isfinite(value(i))) return;
    largest = std::max(largest, std::abs(value(i)));
  }
  const double least = varies * largest;
  int first = 0, last = -rest;  // places of the present run of change
  const auto end_of_row = [&] {
    if (first == 0) return;
    const int from = first - 1, to = last + 1;
    if (last - first <= rest) {
      for (int i = from; i < to; ++i)
        add_change(input, time(i), time(i + 1), value(i), value(i + 1), least);
    } else if (last - first < looks / 4) {  // longer: no step misses it
      add_pulse(time(from), time(to));
    }
  };
  for (int i = 1; i < looks; ++i) {
    if (!(std::abs(value(i + 1) - 2 * value(i) + value(i - 1)) > least)) continue;
    if (i - last > rest) {
      end_of_row();
      first = i;
    }
    last = i;
  }
  end_of_row();
}

}  // namespace momenta
