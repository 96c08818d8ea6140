#define SLIPWAY_KERNEL_ARCH xsimd::sse2
#define SLIPWAY_KERNEL_NAME kWheelKernelSse2
#include "sim/wheel/wheel_kernel_arch.h"
