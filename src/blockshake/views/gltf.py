"""A run as a glTF file (.glb): its blocks as meshes and their poses as an animation, for browsers and viewers."""

import numpy as np
import trimesh
from trimesh.exchange.gltf import export_glb
from trimesh.visual.material import PBRMaterial

from blockshake.files import replacing
from blockshake.pages.scene.bodies import body_colors
from blockshake.views.vtkhdf import local_origin

_UPRIGHT = np.array([[1.0, 0, 0, 0], [0, 0, 1.0, 0], [0, -1.0, 0, 0], [0, 0, 0, 1.0]])  # glTF's y is up
_FLOAT = 5126  # glTF 2.0, section 3.6.2.2: a component of 32 bits


def write_glb(path, run, structure):
    """Write the blocks of a run and their motion as binary glTF 2.0, atomically.

    Notes
    -----
    One node a body, of its name; its translation [m] and rotation are animated, one key a time of the run [s],
    linear in between. All nodes are children of ``inertial frame``, which turns z up into glTF's y up. Translations
    count from `local_origin`, which stands in ``asset.extras.local_origin`` [m] where it is another than 0.
    """
    origin = local_origin(run)
    scene = trimesh.Scene(base_frame="glTF frame")
    scene.graph.update(frame_from="glTF frame", frame_to="inertial frame", matrix=_UPRIGHT)
    colors = body_colors(structure)
    for index, body in enumerate(structure.file.bodies):
        solid = structure.solid(index)
        mesh = trimesh.Trimesh(solid.vertices, solid.triangles, process=False)
        mesh.unmerge_vertices()  # flat faces with sharp edges
        material = PBRMaterial(
            name=body.name, baseColorFactor=[*colors[index], 1.0], metallicFactor=0.0, roughnessFactor=0.9
        )
        mesh.visual = trimesh.visual.TextureVisuals(material=material)
        scene.add_geometry(mesh, node_name=body.name, geom_name=body.name, parent_node_name="inertial frame")

    def animate(buffers, tree):
        _add_animation(buffers, tree, run, origin)
        if origin.any():
            tree["asset"]["extras"] = {"local_origin": origin.tolist()}

    content = export_glb(scene, include_normals=True, buffer_postprocessor=animate)
    with replacing(path) as temporary:
        temporary.write_bytes(content)


def _add_animation(buffers, tree, run, origin):
    """Add the poses of the run to the tree and its buffers, and the first ones to the nodes."""
    nodes = {node["name"]: number for number, node in enumerate(tree["nodes"])}
    times = _accessor(buffers, tree, "time", run["time"].to_numpy(), bounds=True)
    channels, samplers = [], []
    for body in run["body"].values.tolist():
        of_body = run.sel(body=body)
        turns = np.roll(of_body["orientation"].to_numpy(), -1, axis=1)  # glTF's order is x, y, z, w
        paths = {"translation": of_body["position"].to_numpy() - origin, "rotation": turns}
        node = tree["nodes"][nodes[body]]
        node.pop("matrix", None)  # an animated node has none
        for path, values in paths.items():
            node[path] = values[0].tolist()
            channels.append({"sampler": len(samplers), "target": {"node": nodes[body], "path": path}})
            output = _accessor(buffers, tree, f"{body}-{path}", values)
            samplers.append({"input": times, "output": output, "interpolation": "LINEAR"})
    tree["animations"] = [{"name": run.attrs["motion"], "channels": channels, "samplers": samplers}]


def _accessor(buffers, tree, name, values, bounds=False):
    """Number of a new accessor of values, shape (n_keys,) or (n_keys, n_components)."""
    packed = np.ascontiguousarray(values, dtype="<f4")
    accessor = {
        "bufferView": len(buffers),
        "componentType": _FLOAT,
        "count": len(packed),
        "type": "SCALAR" if packed.ndim == 1 else f"VEC{packed.shape[1]}",
    }
    if bounds:
        accessor |= {"min": [float(packed.min())], "max": [float(packed.max())]}
    buffers[name] = packed.tobytes()
    tree["accessors"][name] = accessor
    return len(tree["accessors"]) - 1
