#define SLIPWAY_KERNEL_ARCH xsimd::fma3<xsimd::avx2>
#define SLIPWAY_KERNEL_NAME kWheelKernelAvx2
#include "sim/wheel/wheel_kernel_arch.h"
