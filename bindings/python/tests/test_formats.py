"""Compares the readers with other libraries, on files that those libraries wrote."""

from __future__ import annotations

import csv
import io
import json
import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import p2m

COUNT = 1000


def points(offset: tuple[float, float, float] = (0, 0, 0)) -> np.ndarray:
    return np.random.default_rng(5).uniform(-50, 50, (COUNT, 3)) + offset


@pytest.mark.parametrize("version, form", [("1.2", 0), ("1.2", 3), ("1.4", 6), ("1.4", 8)])
@pytest.mark.parametrize("extension", ["las", "laz"])
def test_las(version: str, form: int, extension: str, tmp_path: Path) -> None:
    laspy = pytest.importorskip("laspy")
    pytest.importorskip("lazrs")
    header = laspy.LasHeader(version=version, point_format=form)
    header.scales, header.offsets = [0.001, 0.001, 0.01], [85000.0, 446000.0, 0.0]
    header.add_extra_dim(laspy.ExtraBytesParams("quality", "uint16"))
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = points((85000, 446000, 0)).T
    path = tmp_path / f"cloud.{extension}"
    cloud.write(path)
    scene = p2m.read(path)
    # The same numbers, bit for bit: scale and offset are applied in the same way.
    assert np.array_equal(scene.vertices, laspy.read(path).xyz)
    assert len(scene.points) == COUNT and scene.unit is None


def test_las_of_several_chunks_and_its_unit(tmp_path: Path) -> None:
    laspy = pytest.importorskip("laspy")
    pyproj = pytest.importorskip("pyproj")
    pytest.importorskip("lazrs")
    for form, version, code, unit in [
        (1, "1.2", 28992, "m"),
        (7, "1.4", 2263, "US survey ft"),
        (6, "1.4", 4326, "degrees"),
    ]:
        header = laspy.LasHeader(version=version, point_format=form)
        header.scales = [1e-5] * 3
        header.add_crs(pyproj.CRS.from_epsg(code), keep_compatibility=form < 6)
        cloud = laspy.LasData(header)
        cloud.x, cloud.y, cloud.z = np.random.default_rng(6).normal(size=(120_000, 3)).T
        path = tmp_path / f"{code}.laz"
        cloud.write(path)
        scene = p2m.read(path)
        assert np.array_equal(scene.vertices, laspy.read(path).xyz)
        # The GeoTIFF keys that laspy writes into old files have no unit.
        assert scene.unit == (unit if form >= 6 else None), code


def test_e57(tmp_path: Path) -> None:
    pye57 = pytest.importorskip("pye57")
    path = tmp_path / "scans.e57"
    file = pye57.E57(str(path), mode="w")
    rotation = np.array([0.9, 0.1, -0.3, 0.2])
    rotation /= np.linalg.norm(rotation)
    for station in range(2):
        x, y, z = points().T
        data = {"cartesianX": x, "cartesianY": y, "cartesianZ": z, "intensity": x}
        file.write_scan_raw(
            data, name=f"station {station}", rotation=rotation, translation=np.array([1, 2, 3 + station])
        )
    file.close()
    file = pye57.E57(str(path))
    expected = [file.read_scan(station, ignore_missing_fields=True) for station in range(2)]
    wanted = np.concatenate([np.stack([s[f"cartesian{axis}"] for axis in "XYZ"], axis=1) for s in expected])
    scene = p2m.read(path)
    assert np.allclose(scene.vertices, wanted, rtol=0, atol=1e-12)
    assert [(o.name, o.start, o.stop) for o in scene.objects] == [
        ("station 0", 0, COUNT),
        ("station 1", COUNT, 2 * COUNT),
    ]
    assert scene.unit == "m"


@pytest.mark.parametrize("encoding", ["ASCII", "BINARY", "BINARY_COMPRESSED"])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_pcd(encoding: str, dtype: Any, tmp_path: Path) -> None:
    pypcd4 = pytest.importorskip("pypcd4")
    path = tmp_path / "cloud.pcd"
    columns = [np.arange(COUNT, dtype=np.uint8), *points().astype(dtype).T]
    types = (np.uint8, dtype, dtype, dtype)
    cloud = pypcd4.PointCloud.from_points(columns, ("label", "x", "y", "z"), types)
    cloud.save(path, encoding=pypcd4.Encoding[encoding])
    expected = pypcd4.PointCloud.from_path(path).numpy(("x", "y", "z"))
    assert np.array_equal(p2m.read(path).vertices, expected.astype(np.float64))


@pytest.mark.parametrize("options", [{}, {"write_ascii": True}, {"compressed": True}])
def test_pcd_of_open3d(options: dict[str, bool], tmp_path: Path) -> None:
    open3d = pytest.importorskip("open3d")
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points()))
    path = str(tmp_path / "cloud.pcd")
    open3d.io.write_point_cloud(path, cloud, **options)
    expected = np.asarray(open3d.io.read_point_cloud(path).points)
    # The fields are of single precision, to which Open3D does not round text.
    assert np.array_equal(p2m.read(path).vertices, expected.astype(np.float32))


def scene_of_trimesh(trimesh: Any, parent: str | None) -> Any:
    scene = trimesh.Scene()
    turn = trimesh.transformations.rotation_matrix(0.5, [1, 2, 3], [0.1, 0.2, 0.3])
    turn[:3, 3] += [10, 20, 30]
    ball, box = trimesh.creation.icosphere(subdivisions=2), trimesh.creation.box((1, 2, 3))
    scene.add_geometry(ball, node_name="ball", geom_name="ball", transform=turn)
    half = trimesh.transformations.scale_matrix(0.5, [1, 0, 0])
    scene.add_geometry(box, node_name="box", geom_name="box", parent_node_name=parent, transform=half)
    scene.add_geometry(box, node_name="second", geom_name="box", transform=turn @ turn)
    return scene


def triangles_of(trimesh: Any, path: Path) -> np.ndarray:
    """Return the corners of all triangles as trimesh reads them, sorted."""
    mesh = trimesh.load(path).to_mesh()
    return sorted_rows(mesh.vertices[mesh.faces].reshape(-1, 9))


def sorted_rows(rows: np.ndarray) -> np.ndarray:
    return rows[np.lexsort(np.round(rows, 3).T)]


@pytest.mark.parametrize("extension", ["glb", "gltf", "3mf"])
def test_scenes_of_trimesh(extension: str, tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    if extension == "3mf":
        pytest.importorskip("lxml")
        pytest.importorskip("networkx")
    path = tmp_path / f"scene.{extension}"
    # trimesh writes two objects with the same number into a 3MF file if a mesh is below another one.
    scene_of_trimesh(trimesh, None if extension == "3mf" else "ball").export(path)
    scene = p2m.read(path)
    found = sorted_rows(scene.vertices[scene.triangles].reshape(-1, 9))
    expected = triangles_of(trimesh, path)
    assert found.shape == expected.shape
    # glTF has single precision, and trimesh multiplies matrices in another order.
    assert np.allclose(found, expected, rtol=0, atol=1e-5)
    assert scene.unit == ("mm" if extension == "3mf" else "m")
    names = [o.name for o in scene.objects]
    assert len(names) == 3 and set(names) == {"ball", "box", "box_1" if extension == "3mf" else "second"}, names


def geometries() -> list[dict[str, Any]]:
    square = [[0, 0], [8, 0], [8, 8], [0, 8], [0, 0]]
    hole = [[2, 2], [2, 5], [5, 5], [5, 2], [2, 2]]
    island = [[20, 20], [22, 20], [21, 23], [20, 20]]
    return [
        {"type": "Point", "coordinates": [30.5, 1.25]},
        {"type": "LineString", "coordinates": [[-5, -5], [-4, -6], [-1, -7]]},
        {"type": "MultiPolygon", "coordinates": [[square, hole], [island]]},
        {"type": "MultiPoint", "coordinates": [[40, 1], [41, 2]]},
    ]


@pytest.mark.parametrize("extension", ["geojson", "shp"])
def test_maps_have_the_distances_of_geopandas(extension: str, tmp_path: Path) -> None:
    geopandas = pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    shapes = [shapely.geometry.shape(geometry) for geometry in geometries()]
    names = ["stop", "track", "parks", "trees"]
    queries = np.random.default_rng(7).uniform(-10, 45, (500, 2))
    # A shapefile has features of one kind.
    kinds = [[0], [1], [2], [3]] if extension == "shp" else [[0, 1, 2, 3]]
    for number, of_kind in enumerate(kinds):
        frame = geopandas.GeoDataFrame(
            {"name": [names[i] for i in of_kind]}, geometry=[shapes[i] for i in of_kind], crs=4326
        )
        path = tmp_path / f"map{number}.{extension}"
        frame.to_file(path, driver="GeoJSON" if extension == "geojson" else "ESRI Shapefile")
        scene = p2m.read(path)
        again = geopandas.read_file(path)
        expected = shapely.distance(shapely.points(queries), again.union_all())
        answers = p2m.Index(scene).closest(np.c_[queries, np.zeros(len(queries))], fields=("distance",))
        assert np.allclose(answers.distance, expected, rtol=1e-12, atol=1e-12)
        assert scene.unit == "degrees"
        if extension == "geojson":
            assert {o.name for o in scene.objects} == set(names)
        else:
            assert set(scene.sources) <= set(range(len(of_kind)))


@pytest.mark.parametrize("kind", ["POINTZ", "POLYLINEZ", "POLYGONM"])
def test_shapefiles_of_pyshp(kind: str, tmp_path: Path) -> None:
    shapefile = pytest.importorskip("shapefile")
    path = tmp_path / "shapes.shp"
    rows = points()[:30]
    with shapefile.Writer(str(path), shapeType=getattr(shapefile, kind)) as writer:
        writer.field("name", "C")
        for number, (x, y, z) in enumerate(rows):
            if kind == "POINTZ":
                writer.pointz(x, y, z)
            elif kind == "POLYLINEZ":
                writer.linez([[[x, y, z], [x + 1, y, z], [x + 1, y + 1, z + 1]]])
            else:
                writer.polym([[[x, y, 0], [x, y + 1, 0], [x + 1, y, 0], [x, y, 0]]])
            writer.record(str(number))
    scene = p2m.read(path)
    with shapefile.Reader(str(path)) as reader:
        shapes = reader.shapes()
        if kind == "POLYGONM":
            expected = np.concatenate([np.asarray(s.points)[:-1] for s in shapes])
            assert np.array_equal(scene.vertices[:, :2], expected) and len(scene.triangles) == 30
        else:
            heights = np.concatenate([np.atleast_1d(s.z) for s in shapes])
            assert np.array_equal(scene.vertices, np.c_[np.concatenate([s.points for s in shapes]), heights])
            assert len(scene.segments) == (60 if kind == "POLYLINEZ" else 0)


def test_tables_have_ids_columns_and_units(tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    rows = points()
    frame = pandas.DataFrame({"nr": [f"P{i}" for i in range(COUNT)], "E [mm]": rows[:, 0], "N [mm]": rows[:, 1]})
    path = tmp_path / "stations.csv"
    frame.to_csv(path, index=False)
    found, ids, unit = p2m.read_points(path, ["E", "N"], id="nr")
    assert np.array_equal(found, np.c_[rows[:, :2], np.zeros(COUNT)])
    assert ids == list(frame["nr"]) and unit == "mm"
    assert np.array_equal(p2m.read_points(path, [2, 3]).points, found)
    with pytest.raises(ValueError, match="there is no column 'H' among nr"):
        p2m.read_points(path, ["E", "N", "H"])
    np.save(tmp_path / "flat.npy", rows[:, :2])
    assert np.array_equal(p2m.read_points(tmp_path / "flat.npy").points, found)
    # PTS files count the points of each scan, and have intensities and colours.
    text = "".join(f"{len(part)}\n" + "".join(f"{x!r} {y!r} {z!r} -100 1 2 3\n" for x, y, z in part.tolist())
                   for part in (rows[:400], rows[400:]))
    (tmp_path / "scans.pts").write_text(text)
    assert np.array_equal(p2m.read(tmp_path / "scans.pts").vertices, rows)


def test_a_file_that_is_not_read_names_a_converter(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="FreeCAD or gmsh convert it to STL"):
        p2m.read(tmp_path / "part.step")
    with pytest.raises(ValueError, match="ogr2ogr of GDAL converts it to GeoJSON"):
        p2m.read(tmp_path / "map.gpkg")


def run(*args: str) -> subprocess.CompletedProcess[str]:
    """Run the program."""
    if "P2M_PROGRAM" not in os.environ:
        pytest.skip("the program is not built")
    return subprocess.run([os.environ["P2M_PROGRAM"], *args], capture_output=True, text=True, check=True)


def test_a_cloud_is_a_scene_a_scan_and_a_list_of_queries(tmp_path: Path) -> None:
    laspy = pytest.importorskip("laspy")
    pytest.importorskip("lazrs")
    cloud = laspy.LasData(laspy.LasHeader(point_format=1, version="1.2"))
    cloud.x, cloud.y, cloud.z = points().T
    path = str(tmp_path / "cloud.laz")
    cloud.write(path)
    rows = csv.DictReader(
        io.StringIO(run("query", path, "--points", path, "--columns", "number,distance,primitive").stdout)
    )
    assert [(row["number"], row["distance"], row["primitive"]) for row in rows] == [
        (str(i), "0.0", str(i)) for i in range(COUNT)
    ]
    part = str(tmp_path / "part.glb")
    trimesh = pytest.importorskip("trimesh")
    trimesh.Scene(trimesh.creation.icosphere(subdivisions=1)).export(part)
    report = json.loads(run("deviation", path, part, "--json").stdout)
    assert report["scan"]["format"] == "las" and report["scan"]["points"] == COUNT


def test_ids_are_in_the_answers_of_the_program(tmp_path: Path) -> None:
    (tmp_path / "map.geojson").write_text(json.dumps(geometries()[1]))
    (tmp_path / "stations.csv").write_text('nr,lon,lat\nP7,-5,-4\n"P,8",0,0\n')
    result = run("query", str(tmp_path / "map.geojson"), "--points", str(tmp_path / "stations.csv"),
                 "--points-columns", "lon,lat", "--points-id", "nr")
    rows = list(csv.DictReader(io.StringIO(result.stdout)))
    assert [(row["id"], float(row["distance"])) for row in rows] == [
        ("P7", pytest.approx(1)),
        ("P,8", pytest.approx(48.4**0.5)),
    ]
    assert "map.geojson has two coordinates for each point: z is 0" in result.stderr
    assert "is in degrees, so distances are no lengths" in result.stderr
    report = json.loads(run("info", "--json", str(tmp_path / "map.geojson")).stdout)
    assert report["unit"] == "degrees"
