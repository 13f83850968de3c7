"""The functions of trimesh, Open3D and libigl, with their names, arguments, shapes, types and signs.

A program changes an import and keeps its calls:

- `p2m.compat.trimesh` for ``trimesh.proximity`` and ``mesh.ray``, in which inside is positive,
- `p2m.compat.open3d` for ``open3d.t.geometry.RaycastingScene``, in which inside is negative,
- `p2m.compat.igl` for ``igl.point_mesh_squared_distance`` and ``igl.signed_distance``, in which inside is negative.

None of them needs the package that it is named after. Their answers are those of `p2m.Index`: the closest point is the
nearest one in float64, of equally near triangles the one with the lowest id is the answer, rays do not pass between
triangles, and signs are right for closed surfaces. Each function documents what differs from its original.
"""

from __future__ import annotations

from . import igl, open3d, trimesh

__all__ = ["igl", "open3d", "trimesh"]
