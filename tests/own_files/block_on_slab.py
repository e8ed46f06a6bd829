"""A structure that studies of these tests name."""

BLOCK = """
name: block
description: a block on a slab
materials: {stone: {density: 2000.0, youngs_modulus: 2.0e10, poisson_ratio: 0.2}}
shapes: {slab: {box: [2, 2, 0.2]}, block: {box: [0.5, 0.5, 1.0]}}
bodies:
  - {name: slab, shape: slab, material: stone, position: [0, 0, -0.1], driven: true}
  - {name: block, shape: block, material: stone, position: [0, 0, 0.5]}
friction: [{pair: [stone, stone], coefficient: 0.7}]
markers: [{name: s, body: slab, position: [1, 0, 0]}, {name: b, body: block, position: [0, 0, 0.5]}]
"""
