//! The lizard in rapier: a chassis and four ball feet on springy joints. This file does
//! not say where the robot goes; rapier computes every contact.

use std::f32::consts::TAU;

use lizard_robot::{CheckedGait, Feet, GRAVITY, Robot, Strut, Travel};
use rapier3d::prelude::*;

use crate::case::Case;

/// Time of a step, s.
const STEP: f32 = 0.001;
/// How long the robot is let alone before the gait begins, s.
const SETTLE: f32 = 0.5;
/// Radius of a foot, m.
const BALL: f32 = 0.008;
/// Mass of a foot, kg.
const FOOT: f32 = 0.015;
/// Damping of a foot that gives, over the critical one of a quarter of the robot.
const DAMPING: f32 = 0.4;

/// How a leg follows its servo: N m/rad and N m s/rad.
#[derive(Clone, Copy, Debug)]
pub struct Yaw(pub f32, pub f32);

impl Yaw {
    /// A leg that does not give.
    pub const RIGID: Self = Self(50.0, 0.08);

    /// A spring of this many N mm/deg. Its damping is small compared with the friction.
    pub fn spring(rate: f64) -> Self {
        Self((rate / 1000.0).to_degrees() as f32, 0.0001)
    }
}

/// The input of the engine.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    /// Where the feet are.
    pub feet: Feet,
    /// All of it, g.
    pub mass: f64,
    /// Between pads and floor.
    pub friction: f64,
    /// How the legs follow their servos.
    pub yaw: Yaw,
    /// Over the gait's own pace.
    pub pace: f64,
    /// How the feet give under the chassis, N/mm.
    pub stiffness: f64,
    /// By how much the front left foot is too long, mm.
    pub long: f64,
    /// The slotted struts between servos and legs; none where `yaw` alone drives the legs.
    pub strut: Option<Strut>,
}

impl Setup {
    /// A robot in a case, at its gaits' own pace.
    #[must_use]
    pub fn of(robot: &Robot, case: Case) -> Self {
        let ground = case.ground(robot);
        Self {
            feet: ground.feet,
            mass: ground.body.mass,
            friction: ground.friction,
            yaw: Yaw::RIGID,
            pace: 1.0,
            stiffness: case.feet.stiffness(robot),
            long: case.feet.long(),
            strut: ground.drive.strut().copied(),
        }
    }
}

/// Left legs turn clockwise when their foot goes forward.
const CLOCKWISE: [f32; 4] = [-1.0, 1.0, 1.0, -1.0];

struct Engine {
    world: PhysicsWorld,
    chassis: RigidBodyHandle,
    feet: [RigidBodyHandle; 4],
    joints: [ImpulseJointHandle; 4],
    yaw: Yaw,
    strut: Option<Strut>,
}

impl Engine {
    fn new(setup: &Setup) -> Self {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, 0.0, -GRAVITY as f32);
        let parameters = &mut world.integration_parameters;
        parameters.dt = STEP;
        parameters.num_solver_iterations = 4;
        // With one, the default, springs are many times too soft.
        parameters.num_internal_pgs_iterations = 60;
        // By default the floor gives as much as a foot's leaf, and a foot that is too long
        // sinks into it.
        parameters.static_contact_softness = SpringCoefficients {
            natural_frequency: 1000.0,
            damping_ratio: 1.0,
        };

        let friction = setup.friction as f32;
        let floor = ColliderBuilder::cuboid(2.0, 2.0, 0.1)
            .translation(Vector::new(0.0, 0.0, -0.1))
            .friction(friction);
        world.colliders.insert(floor);
        let mass = setup.mass as f32 / 1000.0 - 4.0 * FOOT;
        let inertia = mass / 12.0 * 0.02;
        let chassis = RigidBodyBuilder::dynamic()
            .translation(Vector::new(0.0, 0.0, BALL))
            .additional_mass_properties(MassProperties::new(
                Vector::ZERO,
                mass,
                Vector::new(inertia, inertia, inertia),
            ))
            .can_sleep(false);
        let chassis = world.bodies.insert(chassis);
        let metres = |[x, y]: [f64; 2]| Vector::new(x as f32 / 1000.0, y as f32 / 1000.0, 0.0);
        let (hips, pads) = (setup.feet.hips(), setup.feet.at([0.0; 4]));
        let stiffness = 1000.0 * setup.stiffness as f32;
        let damping = DAMPING * 2.0 * (stiffness * setup.mass as f32 / 4000.0).sqrt();
        let long = |foot: usize| match foot {
            0 => setup.long as f32 / 1000.0,
            _ => 0.0,
        };
        let joints = std::array::from_fn(|i| {
            let hip = metres(hips[i]);
            let foot = RigidBodyBuilder::dynamic()
                .translation(hip + Vector::new(0.0, 0.0, BALL))
                .can_sleep(false);
            let foot = world.bodies.insert(foot);
            let pad = ColliderBuilder::ball(BALL)
                .translation(metres(pads[i]) - hip)
                .mass(FOOT)
                .friction(friction);
            world
                .colliders
                .insert_with_parent(pad, foot, &mut world.bodies);
            let locked = JointAxesMask::LIN_X
                | JointAxesMask::LIN_Y
                | JointAxesMask::ANG_X
                | JointAxesMask::ANG_Y;
            let joint = GenericJointBuilder::new(locked)
                .local_anchor1(hip)
                .motor_model(JointAxis::LinZ, MotorModel::ForceBased)
                .motor_model(JointAxis::AngZ, MotorModel::ForceBased)
                .set_motor(JointAxis::LinZ, -long(i), 0.0, stiffness, damping);
            let joint = world
                .impulse_joints
                .insert(chassis, foot, joint.build(), true);
            (foot, joint)
        });
        Self {
            world,
            chassis,
            feet: joints.map(|(foot, _)| foot),
            joints: joints.map(|(_, joint)| joint),
            yaw: setup.yaw,
            strut: setup.strut,
        }
    }

    /// A step towards these sweeps, rad, at these rates, rad/s.
    fn step(&mut self, sweeps: [f32; 4], rates: [f32; 4]) {
        for i in 0..4 {
            let most = self.holds(i, sweeps[i]);
            let joint = self.world.impulse_joints.get_mut(self.joints[i], true);
            let joint = &mut joint.expect("it was inserted").data;
            let (angle, rate) = (CLOCKWISE[i] * sweeps[i], CLOCKWISE[i] * rates[i]);
            joint.set_motor(JointAxis::AngZ, angle, rate, self.yaw.0, self.yaw.1);
            joint.set_motor_max_force(JointAxis::AngZ, most);
        }
        self.world.step();
    }

    /// The most that holds a leg to its servo, which is at a sweep (rad), N m: all there is,
    /// or once the leg lags the way that its strut yields, the strut's spring.
    fn holds(&self, leg: usize, sweep: f32) -> f32 {
        let Some(strut) = &self.strut else {
            return f32::MAX;
        };
        let turned = self.heading(self.feet[leg]) - self.heading(self.chassis);
        let turned = (turned + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
        let lag = f64::from(sweep - CLOCKWISE[leg] * turned);
        let servo = f64::from(sweep).to_degrees();
        let yields = match strut.yields_forward(leg, servo) {
            true => lag,
            false => -lag,
        };
        if yields < 0.0 {
            return f32::MAX;
        }
        let lever = strut.lever(leg, servo);
        let stretch = lever * yields;
        if stretch > strut.slot {
            return f32::MAX;
        }
        ((strut.force + strut.rate * stretch) * lever / 1000.0) as f32
    }

    fn heading(&self, body: RigidBodyHandle) -> f32 {
        let ahead = self.world.bodies[body].rotation() * Vector::X;
        ahead.y.atan2(ahead.x)
    }

    /// Forward, left, m, and heading, rad.
    fn place(&self) -> [f32; 3] {
        let at = self.world.bodies[self.chassis].translation();
        [at.x, at.y, self.heading(self.chassis)]
    }
}

/// Where the second cycle of a gait takes the robot.
pub fn walked(gait: &CheckedGait, setup: &Setup) -> Travel {
    let mut engine = Engine::new(setup);
    let period = gait.period() / setup.pace;
    let sweeps = |seconds: f64| {
        let sweeps = gait.sweeps(gait.phase(seconds.max(0.0) * setup.pace));
        sweeps.map(|sweep| sweep.to_radians() as f32)
    };
    let rates = |seconds: f64| -> [f32; 4] {
        let (before, after) = (sweeps(seconds - 5e-4), sweeps(seconds + 5e-4));
        std::array::from_fn(|i| (after[i] - before[i]) / 1e-3)
    };
    let settle = (SETTLE / STEP) as usize;
    for step in 0..settle {
        // To where the gait begins, without a jerk.
        let share = (2.0 * step as f32 / settle as f32).min(1.0);
        engine.step(sweeps(0.0).map(|sweep| sweep * share), [0.0; 4]);
    }
    let steps = (period / f64::from(STEP)).round() as usize;
    let mut begin = engine.place();
    for step in 0..2 * steps {
        if step == steps {
            begin = engine.place();
        }
        let seconds = (step + 1) as f64 * f64::from(STEP);
        engine.step(sweeps(seconds), rates(seconds));
    }
    let end = engine.place();
    let (sin, cos) = begin[2].sin_cos();
    let (x, y) = (end[0] - begin[0], end[1] - begin[1]);
    let turn = (end[2] - begin[2] + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
    Travel {
        forward: f64::from(1000.0 * (x * cos + y * sin)),
        left: f64::from(1000.0 * (y * cos - x * sin)),
        turn: f64::from(turn.to_degrees()),
    }
}
