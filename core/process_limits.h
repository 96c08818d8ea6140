#pragma once

namespace slipway {

// From now on this process, and those that it starts, get no more address space than this: what asks for more
// fails. Does nothing under the address and thread sanitizers, whose shadow takes all addresses.
void limit_memory(double max_bytes);

// Nor does it leave a core file.
void leave_no_core();

}  // namespace slipway
