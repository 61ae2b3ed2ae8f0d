// SPDX-License-Identifier: GPL-3.0-or-later
// Include before any other header of CGAL's Mesh_3: on a failure it would write files dump-bug.*
// into the current folder and lines to standard error. This header prevents that; the exception has
// the necessary information.
#pragma once

#ifdef CGAL_MESH_3_DUMP_C3T3_H
#error "quiet_cgal.h has to come before CGAL's headers"
#endif
#define CGAL_MESH_3_DUMP_C3T3_H

#include <CGAL/IO/File_medit.h>
#include <CGAL/Mesh_3/Mesh_complex_3_in_triangulation_3_base.h>
#include <CGAL/Mesh_3/io_signature.h>
#include <CGAL/is_streamable.h>

#include <fstream>
#include <string>

namespace CGAL {

template <typename C3t3>
void dump_c3t3(const C3t3&, const std::string&) {}
template <typename C3t3>
void dump_c3t3_edges(const C3t3&, const std::string&) {}

}  // namespace CGAL
