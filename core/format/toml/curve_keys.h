#pragma once
// Keys of loops with curves, slots, cams and racks, and of wheels, beside those of their frames.

#include <momenta/core/format/toml/keys.h>

namespace momenta::reading {

/// The curve of a slot, on which its other keys depend.
void read_kind_of_slot(const Fields& table, LoopSpec& loop);

void declare_slot(Keys& t, LoopSpec& loop);
void declare_cam(Keys& t, LoopSpec& loop);
void declare_rack(Keys& t, LoopSpec& loop);
void declare_rolling(Keys& t, LoopSpec& loop);

}  // namespace momenta::reading
