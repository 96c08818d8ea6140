#define SLIPWAY_KERNEL_ARCH xsimd::avx512bw
#define SLIPWAY_KERNEL_NAME kWheelKernelAvx512
#include "sim/wheel/wheel_kernel_arch.h"
