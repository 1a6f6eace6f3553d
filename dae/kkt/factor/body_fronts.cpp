#include <momenta/dae/kkt/factor/body_fronts.h>
#include <momenta/dae/kkt/factor/faded_pivot.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace momenta {
namespace {

/// A −= inverse h hᵀ, A (size × size) column by column.
void take_away(double* a, int size, double inverse, const double* h) {
  for (int j = 0; j < size; ++j) {
    const double factor = inverse * h[j];
    if (factor == 0) continue;
    double* column = a + static_cast<std::ptrdiff_t>(j) * size;
    for (int i = 0; i < size; ++i) column[i] -= factor * h[i];
  }
}

}  // namespace

bool BodyFronts::factor(const double* compliance, const double* tau) {
  std::fill(value_.begin(), value_.end(), 0.0);
  for (std::size_t i = 0; i < given_.size(); ++i) {
    const Target& to = target_[i];
    if (to.at == none) continue;
    value_[to.at] += given_[i];
    if (to.again != to.at) value_[to.again] += given_[i];
  }
  top_ = 0;
  singular_joint_ = -1;
  for (const Front& f : fronts_) {
    assemble(f, compliance);
    if (!close(f, tau) || !eliminate(f)) return false;
    pass_on(f);
  }
  return true;
}

/// Adds the body's own entries and the fronts below it.
void BodyFronts::assemble(const Front& f, const double* compliance) {
  const std::size_t size = at(f.size());
  std::fill_n(a_.begin(), size * size, 0.0);
  for (int j = 0; j < f.d; ++j) std::copy_n(&value_[f.mass + at(j * f.d)], f.d, &a_[at(j) * size]);
  for (std::size_t e = f.end; e < f.ends; ++e) {
    const std::size_t row = at(f.d + ends_[e].at);
    for (int c = 0; c < f.d; ++c)
      a_[row * size + at(c)] = a_[at(c) * size + row] = value_[ends_[e].value + at(c)];
  }
  if (compliance)
    for (int i = 0; i < f.close; ++i) {
      const int row = f.go_on + i;
      a_[at(f.d + row) * (size + 1)] = -compliance[row_[f.row + at(row)]];
    }
  for (std::size_t b = f.below; b < f.last; ++b) {
    const Front& from = fronts_[at(below_[b])];
    const int passed = from.passed();
    top_ -= at(passed) * at(passed);
    const double* u = &stack_[top_];
    const auto place = [&](int i) {
      return i < f.d ? at(i) : at(f.d + up_[from.up + at(i - f.d)]);
    };
    for (int j = 0; j < passed; ++j) {
      double* column = &a_[place(j) * size];
      for (int i = 0; i < passed; ++i) column[place(i)] += u[at(j) * at(passed) + at(i)];
    }
  }
}

/// Closes loop after loop, of each the strongest row left, relative to where it fades.
bool BodyFronts::close(const Front& f, const double* tau) {
  const int size = f.size(), first = f.left();
  const int* rows = f.close > 0 ? &row_[f.row + at(f.go_on)] : nullptr;
  int* turn = f.close > 0 ? &turn_[f.pivot] : nullptr;
  std::iota(turn, turn + f.close, 0);
  for (int k = 0, last = 0; k < f.close; ++k) {
    while (last < f.close && group_[at(rows[last])] == group_[at(rows[k])]) ++last;
    int best = k;
    double largest = -HUGE_VAL;
    for (int i = k; i < last; ++i) {
      const double fades = tau[rows[turn[i]]];
      const double w = -a_[at(first + turn[i]) * at(size + 1)] / (fades > 0 ? fades : 1);
      if (w > largest) {
        largest = w;
        best = i;
      }
    }
    std::swap(turn[k], turn[best]);
    const int c = first + turn[k], row = rows[turn[k]];
    const double w = -a_[at(c) * at(size + 1)];
    if (!std::isfinite(w)) return false;
    const double inverse = -faded_inverse(w, tau[row]);
    pivot_[at(row)] = w;
    inverse_[f.pivot + at(k)] = inverse;
    double* h = &column_[f.column + at(k) * at(size)];
    std::copy_n(&a_[at(c) * at(size)], size, h);
    for (int i = 0; i <= k; ++i) h[first + turn[i]] = 0;  // rows already closed
    take_away(a_.data(), size, inverse, h);
  }
  return true;
}

/// Eliminates u and drops closed rows.
bool BodyFronts::eliminate(const Front& f) {
  const int size = f.size(), left = f.left(), n = f.rates;
  if (left < size)
    for (int j = 1; j < left; ++j) std::copy_n(&a_[at(j) * at(size)], left, &a_[at(j) * at(left)]);
  double* columns = n > 0 ? &column_[f.column + at(f.close) * at(size)] : nullptr;
  double* D = n > 0 ? &column_[f.coupled] : nullptr;
  for (int j = 0; j < n; ++j) {
    double* h = columns + at(j) * at(left);
    const double* axis = &value_[f.axes + at(j * f.d)];
    std::fill_n(h, left, 0.0);
    for (int c = 0; c < f.d; ++c)
      if (axis[c] != 0)
        for (int i = 0; i < left; ++i) h[i] += axis[c] * a_[at(c) * at(left) + at(i)];
    for (int i = 0; i < n; ++i) {
      const double* other = &value_[f.axes + at(i * f.d)];
      double sum = i == j ? value_[f.rotors + at(j)] : 0;
      for (int c = 0; c < f.d; ++c) sum += other[c] * h[c];
      D[j * n + i] = sum;
    }
  }
  for (std::size_t t = f.tie; t < f.ties; ++t)
    columns[at(ties_[t].rate) * at(left) + at(f.d + ties_[t].at)] += value_[ties_[t].value];
  for (int j = 0; j < n; ++j) {
    const double pivot = D[j * n + j];
    if (!(pivot > 0) || !std::isfinite(pivot)) {
      singular_joint_ = f.rate + j;
      return false;
    }
    const double inverse = 1 / pivot;
    inverse_[f.pivot + at(f.close + j)] = inverse;
    double* h = columns + at(j) * at(left);
    for (int i = j + 1; i < n; ++i) {
      const double factor = D[j * n + i] * inverse;
      if (factor == 0) continue;
      double* other = columns + at(i) * at(left);
      for (int c = 0; c < left; ++c) other[c] -= factor * h[c];
      for (int c = j + 1; c < n; ++c) D[i * n + c] -= factor * D[j * n + c];
    }
    take_away(a_.data(), left, inverse, h);
  }
  return true;
}

/// Puts (𝒯 ⊕ 1)ᵀ A (𝒯 ⊕ 1) onto the stack.
void BodyFronts::pass_on(const Front& f) {
  const int left = f.left(), passed = f.passed();
  const double* transfer = &value_[f.transfer];
  double* to = stack_.data() + top_;
  top_ += at(passed) * at(passed);
  for (int j = 0; j < f.go_on; ++j)
    std::copy_n(&a_[at(f.d + j) * at(left) + at(f.d)], f.go_on,
                &to[at(f.above + j) * at(passed) + at(f.above)]);
  for (int j = 0; j < f.above; ++j) {  // A 𝒯, a column
    double* column = work_.data() + at(j) * at(left);
    std::fill_n(column, left, 0.0);
    for (int c = 0; c < f.d; ++c) {
      const double x = transfer[j * f.d + c];
      if (x == 0) continue;
      for (int i = 0; i < left; ++i) column[i] += x * a_[at(c) * at(left) + at(i)];
    }
    for (int i = 0; i < f.go_on; ++i)
      to[at(j) * at(passed) + at(f.above + i)] = to[at(f.above + i) * at(passed) + at(j)] =
          column[f.d + i];
  }
  for (int j = 0; j < f.above; ++j)
    for (int i = 0; i < f.above; ++i) {
      double sum = 0;
      for (int c = 0; c < f.d; ++c) sum += transfer[i * f.d + c] * work_[at(j * left + c)];
      to[at(j * passed + i)] = sum;
    }
}

void BodyFronts::solve(double* x) {
  double* sigma = x + nv_;
  std::fill(motion_.begin(), motion_.end(), 0.0);
  for (std::size_t k = 0; k < fronts_.size(); ++k) {
    const Front& f = fronts_[k];
    const int size = f.size(), left = f.left(), n = f.rates;
    double* y = &motion_[k * at(d_)];
    const int* rows = row_.data() + f.row;
    const double* h = column_.data() + f.column;
    for (int c = 0; c < f.close; ++c, h += size) {
      const double z = inverse_[f.pivot + at(c)] * sigma[rows[f.go_on + turn_[f.pivot + at(c)]]];
      for (int i = 0; i < f.d; ++i) y[i] -= z * h[i];
      for (int i = f.d; i < size; ++i) sigma[rows[i - f.d]] -= z * h[i];
    }
    double* u = x + f.rate;
    for (int j = 0; j < n; ++j)
      for (int c = 0; c < f.d; ++c) u[j] += value_[f.axes + at(j * f.d + c)] * y[c];
    const double* D = column_.data() + f.coupled;
    for (int j = 0; j < n; ++j, h += left) {
      const double z = inverse_[f.pivot + at(f.close + j)] * u[j];
      for (int i = j + 1; i < n; ++i) u[i] -= z * D[j * n + i];
      for (int i = 0; i < f.d; ++i) y[i] -= z * h[i];
      for (int i = f.d; i < left; ++i) sigma[rows[i - f.d]] -= z * h[i];
    }
    if (f.above == 0) continue;
    double* above = &motion_[at(f.parent) * at(d_)];
    for (int j = 0; j < f.above; ++j)
      for (int c = 0; c < f.d; ++c) above[j] += value_[f.transfer + at(j * f.d + c)] * y[c];
  }
  for (std::size_t k = fronts_.size(); k-- > 0;) {
    const Front& f = fronts_[k];
    const int size = f.size(), left = f.left(), n = f.rates;
    double* omega = &motion_[k * at(d_)];
    const int* rows = row_.data() + f.row;
    std::fill_n(omega, f.d, 0.0);
    if (f.above > 0) {
      const double* above = &motion_[at(f.parent) * at(d_)];
      for (int j = 0; j < f.above; ++j)
        for (int c = 0; c < f.d; ++c) omega[c] += value_[f.transfer + at(j * f.d + c)] * above[j];
    }
    double* u = x + f.rate;
    const double* D = column_.data() + f.coupled;
    const double* h = column_.data() + f.column + at(f.close) * at(size) + at(n) * at(left);
    for (int j = n; j-- > 0;) {
      h -= left;
      double z = u[j];
      for (int i = 0; i < f.d; ++i) z -= h[i] * omega[i];
      for (int i = f.d; i < left; ++i) z -= h[i] * sigma[rows[i - f.d]];
      for (int i = j + 1; i < n; ++i) z -= D[j * n + i] * u[i];
      u[j] = inverse_[f.pivot + at(f.close + j)] * z;
    }
    for (int j = 0; j < n; ++j)
      for (int c = 0; c < f.d; ++c) omega[c] += value_[f.axes + at(j * f.d + c)] * u[j];
    h = column_.data() + f.column + at(f.close) * at(size);
    for (int c = f.close; c-- > 0;) {
      h -= size;
      double& own = sigma[rows[f.go_on + turn_[f.pivot + at(c)]]];
      double z = own;
      for (int i = 0; i < f.d; ++i) z -= h[i] * omega[i];
      for (int i = f.d; i < size; ++i)
        if (h[i] != 0) z -= h[i] * sigma[rows[i - f.d]];
      own = inverse_[f.pivot + at(c)] * z;
    }
  }
}

}  // namespace momenta
