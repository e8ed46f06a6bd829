"""Shaken blocks in MuJoCo, run by the peers' Python: ``python mujoco_laboratory.py TASK RESULT``.

Rigid boxes with elliptic friction cones and stiff soft contact. The laboratory shares no code with blockshake: TASK is
a JSON file of plain numbers, as `mujoco_task.py` writes it, RESULT an npz file with, for every test of a number N:

``N-pose`` (n, n_bodies, 7): place of each body's middle [m] and unit quaternion (w, x, y, z), every `EVERY` steps from
the start of the shaking on, in the inertial frame; ``N-force`` (n_steps, n_sensors, 3): specific force of each
accelerometer in the body's axes, mean of each step [m/s2]; ``N-factor``: by which the motion was made smaller so that
no block tilts farther than is requested; ``N-tilt``: largest tilt [rad]; ``N-deepest``: largest penetration [m].

The table rests and gravity shakes, ``(-a(t), 0, -g - a_z(t))``: the same mechanics in the table's frame. A table that
pitches adds the forces of a rotating frame.
"""

import json
import sys
from itertools import product

import mujoco
import numpy as np

GRAVITY = 9.81  # m/s2
TIME_STEP = 2e-4  # s
EVERY = 5  # steps from one kept pose to the next
REST = 0.5  # s, before the shaking
CONTACT = 5e-4  # s, time constant of the contact at critical damping
IMPEDANCE = "0.99 0.999 1e-4 0.5 2"
LAYER = 5e-3  # s, first guess at the time constant of a soft layer
LAYER_IMPEDANCE = "0.95 0.95 1e-4 0.5 2"  # alike at all depths: a linear layer
SLICES = 8  # of a soft joint, along x
SMALLEST_FACTOR, SMALLER = 0.3, 0.9
_SLOW = 0.01  # m/s, below which dry friction against the table is viscous
_SIDE = 1e-3  # m/s, above which slip has a side


class Laboratory:
    """A model of one test and its state."""

    def __init__(self, task, test):
        self.task, self.test = task, test
        self.names = [body["name"] for body in task["bodies"]]
        self.model = mujoco.MjModel.from_xml_string(self._xml())
        self.data = mujoco.MjData(self.model)
        self.of = {name: self.model.body(name).id for name in self.names}
        for body in task["bodies"]:
            self.model.body_ipos[self.of[body["name"]]] += body["mass_offset"]
        mujoco.mj_setConst(self.model, self.data)
        self.start = {
            body["name"]: np.array(pose) for body, pose in zip(task["bodies"], test["poses"], strict=True)
        }
        self._put()
        self._soften()
        self._put()

    def _xml(self):
        """MuJoCo's description: a mesh for mass and inertia, boxes of the bearing faces for contact."""
        meshes, bodies, pairs, sensors = [], [], [], []
        chamfers = self.test["chamfers"]
        soft = {joint["upper"] for joint in self.task["joints"] if joint["compliance"] > 0.0}
        for body in self.task["bodies"]:
            name, half = body["name"], 0.5 * np.array(body["box"])
            meshes.append(f'<mesh name="{name}" vertex="{_words(_corners(half, body["chamfer"]))}"/>')
            bearing = half - [chamfers[name], chamfers[name], 0.0]
            bodies.append(
                f'<body name="{name}" pos="{_words(body["position"])}"><freejoint name="{name}"/>'
                f'<geom type="mesh" mesh="{name}" density="{body["density"]}"/>'
                f"{_boxes(name, bearing, name in soft)}{self._sites(name)}</body>"
            )
        for number, joint in enumerate(self.task["joints"]):
            pairs += self._pairs(number, joint)
        for number in range(len(self.task["sensors"])):
            sensors.append(f'<accelerometer site="sensor-{number}"/>')
        slab = self.task["slab"]
        half = 0.5 * np.array(slab["box"])
        hinge = ""
        if slab["compliance"]:
            stiffness = 1.0 / slab["compliance"]
            hinge = (
                f'<joint name="hinge" type="hinge" axis="0 1 0" pos="0 0 {-half[2]}" '
                f'stiffness="{stiffness}" damping="{slab["damping"]}"/>'
            )
        table = (
            f'<body name="{slab["name"]}" pos="{_words(slab["position"])}">{hinge}'
            f'<geom type="box" size="{_words(half)}" density="{slab["density"]}"/>'
            f"{_boxes(slab['name'], half, False)}{self._sites(slab['name'])}</body>"
        )
        return (
            f'<mujoco><option timestep="{TIME_STEP}" cone="elliptic" impratio="100" solver="Newton" '
            f'iterations="100" tolerance="1e-10" gravity="0 0 {-GRAVITY}"/>'
            '<default><geom contype="0" conaffinity="0"/></default>'
            f"<asset>{''.join(meshes)}</asset><worldbody>{table}{''.join(bodies)}</worldbody>"
            f"<contact>{''.join(pairs)}</contact><sensor>{''.join(sensors)}</sensor></mujoco>"
        )

    def _sites(self, name):
        return "".join(
            f'<site name="sensor-{number}" pos="{_words(sensor["position"])}"/>'
            for number, sensor in enumerate(self.task["sensors"])
            if sensor["body"] == name
        )

    def _pairs(self, number, joint):
        """Contact of a joint: face on face, or slice by slice on a soft layer."""
        mu, damping = joint["friction"], joint["damping_ratio"]
        soft = joint["compliance"] > 0.0
        rigid = f'solref="{CONTACT / damping} {damping}" solimp="{IMPEDANCE}"'
        layer = f'solref="{LAYER} 1" solimp="{LAYER_IMPEDANCE}"'
        return [
            f'<pair name="{name}" geom1="{joint["lower"]}" geom2="{joint["upper"]}{name.removeprefix(str(number))}" '
            f'condim="3" friction="{mu} {mu} 0 0 0" {layer if soft else rigid}/>'
            for name in _pair_names(number, joint)
        ]

    def _put(self):
        """Every body where the test has it at the start."""
        mujoco.mj_resetData(self.model, self.data)
        for name, pose in self.start.items():
            self.data.joint(name).qpos[:] = pose
        mujoco.mj_forward(self.model, self.data)

    def _soften(self):
        """Time constants of soft layers: at rest each is pressed in by its compliance times the pressure.

        The depth at rest goes with the square of the time constant, since the layer's impedance is constant.
        """
        soft = {
            number: joint for number, joint in enumerate(self.task["joints"]) if joint["compliance"] > 0.0
        }
        for _ in range(3 if soft else 0):
            self._put()
            for _ in range(round(0.4 / TIME_STEP)):
                mujoco.mj_step(self.model, self.data)
            for number, joint in soft.items():
                force, depth, area = self._pressed(number, joint)
                wanted = joint["compliance"] * force / area
                for part in range(SLICES):
                    self.model.pair(f"{number}/{part}").solref[0] *= np.sqrt(wanted / max(depth, 1e-9))

    def _pressed(self, number, joint):
        """Normal force of a joint at rest [N], its mean depth [m] and its area [m2]."""
        force, depths, wrench = 0.0, [], np.zeros(6)
        ids = {self.model.pair(f"{number}/{part}").id for part in range(SLICES)}
        upper = {self.model.geom(f"{joint['upper']}/{part}").id for part in range(SLICES)}
        lower = self.model.geom(joint["lower"]).id
        for index, contact in enumerate(self.data.contact):
            if ids and {contact.geom1, contact.geom2} & upper and lower in (contact.geom1, contact.geom2):
                mujoco.mj_contactForce(self.model, self.data, index, wrench)
                force += wrench[0]
                depths.append(-contact.dist)
        size = self.model.geom(f"{joint['upper']}/0").size
        return force, float(np.mean(depths)), 4.0 * SLICES * size[0] * size[1]

    def shake(self, factor):
        """One run with the motion by a factor: `main`'s arrays by name; None where a block tilts too far."""
        model, data, test = self.model, self.data, self.test
        motion = {name: factor * np.array(values) for name, values in test["motion"].items()}
        rest, steps = (0 if test["at_once"] else round(REST / TIME_STEP)), len(motion["x"])
        self._put()
        poses = np.empty((steps // EVERY + 1, len(self.names), 7))
        slab = np.zeros(steps // EVERY + 1)
        forces = np.empty((steps, len(self.task["sensors"]), 3))
        joints = [data.joint(name) for name in self.names]
        hinge = data.joint("hinge") if self.task["slab"]["compliance"] else None
        deepest = tilt = 0.0
        laws = _Laws(self)
        acting = _Forces(self)
        frame = _Frame(self, motion)
        for step in range(-rest, steps):
            shaking = max(step, 0)
            model.opt.gravity[:] = frame.gravity(shaking) if step >= 0 else (0.0, 0.0, -GRAVITY)
            data.qfrc_applied[:] = 0.0
            acting(step * TIME_STEP)
            if step >= 0:
                if step % EVERY == 0:
                    for number, joint in enumerate(joints):
                        poses[step // EVERY, number] = joint.qpos
                    slab[step // EVERY] = hinge.qpos[0] if hinge else 0.0
                frame.act(step)
            laws()
            mujoco.mj_step(model, data)
            if step >= 0:
                forces[step] = frame.felt(step, data.sensordata.reshape(-1, 3))
            if step % 50 == 0:
                tilt = max(tilt, *(_tilt(joint.qpos[3:]) for joint in joints))
                deepest = max([deepest, *(-contact.dist for contact in data.contact)])
                if tilt > test["most_tilt"]:
                    return None
        for number, joint in enumerate(joints):
            poses[-1, number] = joint.qpos
        slab[-1] = hinge.qpos[0] if hinge else 0.0
        whole = frame.inertial(poses, slab)
        return {"pose": whole, "force": forces, "tilt": tilt, "deepest": deepest, "factor": factor}


class _Laws:
    """Friction of joints that hangs on the slip: the coefficients of every step."""

    def __init__(self, laboratory):
        self.laboratory = laboratory
        self.joints = [
            (number, joint, [laboratory.model.pair(name) for name in _pair_names(number, joint)])
            for number, joint in enumerate(laboratory.task["joints"])
            if joint["law"]
        ]
        self.slipped = np.zeros(len(laboratory.task["joints"]))
        self.speed = np.zeros(6), np.zeros(6)

    def __call__(self):
        for number, joint, pairs in self.joints:
            slip = self._slip(joint)
            self.slipped[number] += abs(slip) * TIME_STEP
            mu, law = joint["friction"], joint["law"]
            mu *= 1.0 + law["asymmetry"] * np.tanh(slip / _SIDE)
            mu *= 1.0 - law["rate_drop"] * (1.0 - np.exp(-abs(slip) / law["rate_scale"]))
            mu *= 1.0 - law["slip_drop"] * (1.0 - np.exp(-self.slipped[number] / law["slip_scale"]))
            for pair in pairs:
                pair.friction[:2] = mu

    def _slip(self, joint):
        """Velocity along x of the upper body against the lower one, at the upper one's lower face [m/s]."""
        model, data = self.laboratory.model, self.laboratory.data
        upper = data.body(joint["upper"])
        point = upper.xpos - upper.xmat.reshape(3, 3)[:, 2] * model.geom(joint["upper"]).size[2]
        found = []
        for name, speed in zip((joint["upper"], joint["lower"]), self.speed, strict=True):
            body = model.body(name).id
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, body, speed, 0)
            turning, moving = speed[:3], speed[3:]
            found.append(moving[0] + turning[1] * (point[2] - data.xpos[body, 2]))
        return found[0] - found[1]


class _Forces:
    """Forces of a test on bodies, along x: histories, springs, dashpots, dry drags, stops."""

    def __init__(self, laboratory):
        self.laboratory = laboratory
        data = laboratory.data
        self.forces = []
        for force in laboratory.test["forces"]:
            body = laboratory.of[force["body"]]
            at = np.array(force["position"])
            self.forces.append((force, body, at, _point(data, body, at)[0]))
        self.speed, self.none = np.zeros(6), np.zeros(3)

    def __call__(self, time):
        model, data = self.laboratory.model, self.laboratory.data
        for force, body, at, start in self.forces:
            point = _point(data, body, at)
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, body, self.speed, 0)
            moved = point[0] - start
            speed = self.speed[3] + self.speed[1] * (point[2] - data.xpos[body, 2])
            total = np.interp(time, force["times"], force["values"]) if force["times"] else 0.0
            total -= force["stiffness"] * moved + force["damping"] * speed
            total -= force["dry"] * np.tanh(speed / _SLOW)
            for side, gap, stiffness in force["stops"]:
                total -= side * stiffness * max(side * moved - gap, 0.0)
            pull = np.array([total, 0.0, 0.0])
            mujoco.mj_applyFT(model, data, pull, self.none, point, body, data.qfrc_applied)


class _Frame:
    """The table's frame: its gravity, the forces of its pitch, and the way back to the inertial frame."""

    def __init__(self, laboratory, motion):
        self.laboratory, self.motion = laboratory, motion
        model = laboratory.model
        self.pitches = bool(np.any(motion["pitch"]))
        self.axis = np.array(laboratory.task["slab"]["position"])
        self.rate = np.gradient(motion["pitch"], TIME_STEP)
        self.acceleration = np.gradient(self.rate, TIME_STEP)
        self.inertia = {}
        for name, body in laboratory.of.items():
            turn = np.zeros(9)
            mujoco.mju_quat2Mat(turn, model.body_iquat[body])
            turn = turn.reshape(3, 3)
            self.inertia[name] = float((turn * model.body_inertia[body] @ turn.T)[1, 1])
        self.speed = np.zeros(6)

    def gravity(self, step):
        pitch = self.motion["pitch"][step]
        x, z = -self.motion["x"][step], -GRAVITY - self.motion["z"][step]
        return np.cos(pitch) * x - np.sin(pitch) * z, 0.0, np.sin(pitch) * x + np.cos(pitch) * z

    def act(self, step):
        """Forces of the rotating frame on every body."""
        if not self.pitches:
            return
        model, data = self.laboratory.model, self.laboratory.data
        for name, body in self.laboratory.of.items():
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, body, self.speed, 0)
            pull = model.body_mass[body] * self._apparent(step, data.xipos[body], self.speed[3:])
            turn = np.array([0.0, -self.inertia[name] * self.acceleration[step], 0.0])
            mujoco.mj_applyFT(model, data, pull, turn, data.xipos[body], body, data.qfrc_applied)

    def felt(self, step, sensed):
        """Specific forces of the sensors, without the apparent ones of the frame."""
        if not self.pitches:
            return sensed
        data = self.laboratory.data
        found = sensed.copy()
        for number in range(len(sensed)):
            site = data.site(f"sensor-{number}")
            apparent = self._apparent(step, site.xpos, np.zeros(3))
            found[number] -= site.xmat.reshape(3, 3).T @ apparent
        return found

    def _apparent(self, step, place, velocity):
        """Apparent acceleration at a place that moves in the frame, of a turn about y."""
        x, _, z = place - self.axis
        rate, grows = self.rate[step], self.acceleration[step]
        return np.array([
            -grows * z + rate**2 * x - 2.0 * rate * velocity[2],
            0.0,
            grows * x + rate**2 * z + 2.0 * rate * velocity[0],
        ])  # fmt: skip

    def inertial(self, poses, slab):
        """Poses of slab and bodies in the inertial frame; the slab first."""
        task = self.laboratory.task
        half = 0.5 * task["slab"]["box"][2]
        own = np.zeros((len(poses), 1, 7))
        # a slab on its bed turns about its bottom
        own[:, 0, 0] = self.axis[0] + half * np.sin(slab)
        own[:, 0, 1] = self.axis[1]
        own[:, 0, 2] = self.axis[2] - half + half * np.cos(slab)
        own[:, 0, 3], own[:, 0, 5] = np.cos(0.5 * slab), np.sin(0.5 * slab)
        whole = np.concatenate([own, poses], axis=1)
        pitch = np.append(self.motion["pitch"], self.motion["pitch"][-1])[::EVERY]
        cosine, sine = np.cos(pitch)[:, None], np.sin(pitch)[:, None]
        x, z = whole[..., 0] - self.axis[0], whole[..., 2] - self.axis[2]
        moved = whole.copy()
        moved[..., 0] = self.axis[0] + cosine * x + sine * z + self.motion["moved_x"][:, None]
        moved[..., 2] = self.axis[2] - sine * x + cosine * z + self.motion["moved_z"][:, None]
        a, b = np.cos(0.5 * pitch)[:, None], np.sin(0.5 * pitch)[:, None]
        w, i, j, k = (whole[..., 3 + part] for part in range(4))
        moved[..., 3:] = np.stack([a * w - b * j, a * i + b * k, a * j + b * w, a * k - b * i], axis=-1)
        return moved


def _corners(half, chamfer):
    """Corners of a block whose edges are cut: of each face, those inset along its two own axes."""
    for axis, *signs in product(range(3), *[(-1.0, 1.0)] * 3):
        cut = np.full(3, chamfer)
        cut[axis] = 0.0
        yield from np.array(signs) * (half - cut)


def _boxes(name, half, sliced):
    """Box of a block's bearing faces, and its slices along x for a soft layer."""
    whole = f'<geom name="{name}" type="box" size="{_words(half)}" mass="0"/>'
    thin = half / [SLICES, 1.0, 1.0]
    for part in range(SLICES if sliced else 0):
        at = (2 * part + 1 - SLICES) * thin[0]
        whole += f'<geom name="{name}/{part}" type="box" size="{_words(thin)}" pos="{at} 0 0" mass="0"/>'
    return whole


def _pair_names(number, joint):
    """Names of the contact pairs of a joint: one, or one a slice of a soft layer."""
    soft = joint["compliance"] > 0.0
    return [f"{number}/{part}" for part in range(SLICES)] if soft else [str(number)]


def _words(values):
    return " ".join(f"{value:.9g}" for value in values)


def _point(data, body, at):
    return data.xpos[body] + data.xmat[body].reshape(3, 3) @ at


def _tilt(quaternion):
    """Angle of a body's upward axis against the vertical [rad]."""
    return float(np.arccos(np.clip(1.0 - 2.0 * (quaternion[1] ** 2 + quaternion[2] ** 2), -1.0, 1.0)))


def main(task):
    """Every test of a task, each with the largest motion by which no block tilts too far."""
    found = {}
    for number, test in enumerate(task["tests"]):
        laboratory, factor, run = Laboratory(task, test), 1.0, None
        while run is None:
            run = laboratory.shake(factor)
            factor *= SMALLER
            if factor < SMALLEST_FACTOR:
                raise RuntimeError(f"test {number}: a block tilts too far at {factor:g} of the motion")
        found |= {f"{number}-{name}": values for name, values in run.items()}
    return found


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as asked:
        answer = main(json.load(asked))
    np.savez(sys.argv[2], **{name: np.asarray(values) for name, values in answer.items()})
