#pragma once

namespace slipway::dem {

// Limits the files that PROJ may open, which has file access of its own beside GDAL's. A text of a coordinate
// system can name files: a file of definitions (+init=FILE:CODE, also within WKT) and files of grids. In a
// program that links this, PROJ opens files for reading only, and only those in the folder of its own
// database.
void raise_projection_fence();

}  // namespace slipway::dem
