#pragma once

namespace slipway::dem {

// Limits the files that PROJ may open, which has file access of its own beside GDAL's. A text of a coordinate
// system can name files: a file of definitions (+init=FILE:CODE, also within WKT) and files of grids. Once
// this fence is raised, in this whole process, PROJ opens files for reading only, and only those in the
// folder of its own database.
void raise_projection_fence();

// Puts the calling thread's projections behind the fence, whatever it has done before.
void fence_projections_of_thread();

}  // namespace slipway::dem
