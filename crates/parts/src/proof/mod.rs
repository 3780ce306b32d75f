//! Proof that no two parts meet at any pose that the guard accepts.
//!
//! Poses are not sampled. The servos' angles are divided into regions. For each region
//! the proof shows either that the guard accepts no pose in it, or that the parts stay
//! apart in all of it: in its middle they have a distance, and no point can move from
//! there by more than its rate times the region's half width. Rates come from the closed
//! forms of the mechanism, taken on bounds instead of numbers (`interval.rs`,
//! `slope.rs`), which bound a coupler near a singularity as well as a crank. If a region
//! proves nothing, its halves are tried (`search.rs`).
//!
//! The position of two parts to each other depends only on the servos of their mounts
//! ([`Mount::servos`](crate::Mount::servos)): which are one or two, rarely three. So the
//! whole proof takes seconds. `solids.rs` lists what has to keep clear of what,
//! `sweep.rs` leaves out pairs that are never close, `guard.rs` knows what the guard
//! certainly refuses.

pub(crate) mod clearance;
mod first;
mod guard;
mod interval;
mod search;
mod slope;
mod solids;
mod sweep;

use std::fmt;

use lizard_kinematics::Solution;
use serde::{Deserialize, Serialize};

use crate::bodies::assembly::Assembly;
use crate::layers::body::Body;
use crate::proof::clearance::Clearance;
use guard::Guard;
pub use search::ENOUGH;
use search::Found;
use solids::Task;

/// What all parts keep from each other, but those that are made to meet, mm: more than
/// a printed part is off.
pub const LEAST: f64 = 0.2;
/// What is made to meet may touch; by so much it is not an overlap, mm.
const TOUCH: f64 = 0.02;

/// Angles of each servo at whose poses the joints are checked.
const JOINT_STEPS: u32 = 6;

/// Two parts, and how near they come.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Near {
    /// One body.
    pub first: String,
    /// The other.
    pub second: String,
    /// At every pose that the guard accepts they are apart by this or more, mm; below
    /// 0 they may overlap.
    pub proved: f64,
    /// A pose that it accepts where they are nearly as near as that; `None` where they
    /// are no nearer than [`ENOUGH`], or none is found.
    pub seen: Option<Clearance>,
    /// Servo angles, deg, near which no more is proved, if that is much less than what
    /// was seen. The guard hardly accepts them, if at all.
    pub doubt: Option<[f64; 4]>,
}

/// That a robot's parts keep clear of each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Proof {
    /// Parts that are not made to meet, the nearest first: of all that moves with one
    /// mount and all that moves with another, the nearest two.
    pub apart: Vec<Near>,
    /// The same for parts that are made to meet, as a pin and its hole: the air between
    /// them.
    pub meeting: Vec<Near>,
    /// From and to, deg: no servo is ever beyond this in a pose that the guard accepts.
    pub ranges: [[f64; 2]; 4],
    /// Pairs of shapes checked.
    pub pairs: usize,
    /// Regions of poses checked.
    pub regions: u64,
}

/// Two parts that do not keep clear of each other.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Clash {
    /// Two parts overlap.
    #[error("{0}")]
    Overlap(Box<Clearance>),
    /// Two parts come too near to each other.
    #[error("{0}, which is less than {LEAST} mm")]
    Narrow(Box<Clearance>),
    /// At poses that the guard hardly accepts, two parts may overlap.
    #[error("{0}")]
    Unsure(Box<Near>),
}

impl fmt::Display for Near {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self {
            first,
            second,
            proved,
            ..
        } = self;
        match self.doubt {
            Some([a, b, c, d]) if *proved < 0.0 => write!(
                f,
                "{first} and {second} may overlap by {:.2} mm near pose {a:.2} {b:.2} {c:.2} {d:.2}",
                -proved
            ),
            Some([a, b, c, d]) => write!(
                f,
                "{first} and {second} may come as near as {proved:.2} mm near pose {a:.2} {b:.2} {c:.2} {d:.2}"
            ),
            None => write!(f, "{first} and {second} are {proved:.2} mm apart or more"),
        }
    }
}

impl Near {
    /// What is wrong with it, if they have to keep this distance, mm.
    fn clash(&self, least: f64) -> Option<Clash> {
        match &self.seen {
            Some(seen) if seen.mm < least.min(0.0) => Some(Clash::Overlap(Box::new(seen.clone()))),
            Some(seen) if seen.mm < least => Some(Clash::Narrow(Box::new(seen.clone()))),
            _ if self.proved < least => Some(Clash::Unsure(Box::new(self.clone()))),
            _ => None,
        }
    }

    /// How near they are for all that is known, mm.
    fn mm(&self) -> f64 {
        self.seen.as_ref().map_or(self.proved, |seen| seen.mm)
    }
}

impl Proof {
    /// The nearest two parts that are not made to meet.
    #[must_use]
    pub fn least(&self) -> Option<&Near> {
        self.apart.first()
    }

    /// Whether the parts fit.
    ///
    /// # Errors
    /// The two parts that overlap most, the pose, and by how much; else two that come
    /// nearer than [`LEAST`].
    pub fn judge(&self) -> Result<(), Clash> {
        let apart = self.apart.iter().map(|near| (near, LEAST));
        let meeting = self.meeting.iter().map(|near| (near, -TOUCH));
        let worst = apart
            .chain(meeting)
            .filter_map(|(near, least)| near.clash(least).map(|clash| (near.mm(), clash)))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        worst.map_or(Ok(()), |(_, clash)| Err(clash))
    }
}

/// All that a proof asks: of what moves with one mount and what moves with another, how near
/// they come. Each can be answered without the others, on another machine as well.
pub struct Questions<'a> {
    assembly: &'a Assembly,
    guard: Guard<'a>,
    tasks: Vec<Task>,
    /// Whether parts are seen to meet; then the tasks are those that meet most.
    seen: bool,
    joints: Vec<Solution>,
}

/// The answer to one question.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// The nearest of what is pinned, which is made to meet.
    pinned: Option<Near>,
    /// The closest of all others, and the regions of poses checked.
    nearest: Option<(Near, u64)>,
}

impl<'a> Questions<'a> {
    /// Those of some pairs of bodies.
    pub fn new(assembly: &'a Assembly, which: impl Fn(&Body, &Body) -> bool) -> Self {
        let guard = Guard::new(assembly.robot());
        let tasks = Task::all(assembly, &guard, ENOUGH, which);
        let worst = first::worst(assembly, &tasks);
        Self {
            seen: worst.is_some(),
            tasks: worst.unwrap_or(tasks),
            joints: assembly.poses(JOINT_STEPS).collect(),
            guard,
            assembly,
        }
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.tasks.len()
    }

    /// The answer to one, by its place below [`Questions::count`].
    #[must_use]
    pub fn one(&self, place: usize) -> Answer {
        self.within(place, search::MANY)
    }

    /// The answer to one that looks at no more than `most` regions.
    fn within(&self, place: usize, most: u64) -> Answer {
        let mut task = self.tasks[place].clone();
        let pinned = match task.meet {
            true => self.assembly.take_joint(&mut task, &self.joints),
            false => None,
        };
        let nearest = (!task.solids.is_empty()).then(|| {
            let found = search::least(self.assembly, &self.guard, &task, most);
            let regions = found.regions;
            (self.assembly.near(found), regions)
        });
        Answer { pinned, nearest }
    }

    /// The proof. Answers that [`Questions::one`] gave elsewhere are taken from `known`, by
    /// their places. It ends at the first parts that do not fit; where they only may not,
    /// what follows is checked less closely, and not taken from `known`.
    pub fn answer(
        &self,
        mut known: impl FnMut(usize) -> Option<Answer>,
        mut progress: impl FnMut(usize, usize),
    ) -> Proof {
        let mut most = search::MANY;
        let mut proof = Proof {
            apart: Vec::new(),
            meeting: Vec::new(),
            ranges: self.guard.ranges.map(|range| [range.low, range.high]),
            pairs: self.tasks.iter().map(|task| task.solids.len()).sum(),
            regions: 0,
        };
        let count = self.count();
        for (place, task) in self.tasks.iter().enumerate() {
            progress(place, count);
            let answer = match most {
                search::MANY => known(place).unwrap_or_else(|| self.one(place)),
                fewer => self.within(place, fewer),
            };
            proof.meeting.extend(answer.pinned);
            let Some((near, regions)) = answer.nearest else {
                continue;
            };
            proof.regions += regions;
            let clash = near.clash(task.least());
            if task.meet {
                proof.meeting.push(near);
            } else {
                proof.apart.push(near);
            }
            // One is enough, and where parts hardly fit each takes long.
            match clash {
                Some(Clash::Unsure(_)) => most = search::MANY / 10,
                Some(_) if !self.seen => break,
                _ => {}
            }
        }
        progress(count, count);
        for list in [&mut proof.apart, &mut proof.meeting] {
            list.sort_by(|a, b| a.proved.total_cmp(&b.proved));
        }
        proof
    }
}

impl Assembly {
    /// How near any two parts come at any pose that the guard accepts; whether that is
    /// near enough to fit, [`Proof::judge`] says. If parts are seen to meet already at one
    /// of some poses, it is of the worst of them alone; else it ends at the first that do
    /// not fit. `progress` is called with what is done and what there is to do.
    pub fn prove(&self, progress: impl FnMut(usize, usize)) -> Proof {
        self.prove_some(|_, _| true, progress)
    }

    /// The same for some pairs of bodies.
    pub fn prove_some(
        &self,
        which: impl Fn(&Body, &Body) -> bool,
        progress: impl FnMut(usize, usize),
    ) -> Proof {
        Questions::new(self, which).answer(|_| None, progress)
    }

    /// Takes what is pinned out of a task: pins in round holes, whose centres are one
    /// point of the linkage, so that they stay as they are.
    fn take_joint(&self, task: &mut Task, poses: &[Solution]) -> Option<Near> {
        let places: Vec<_> = poses
            .iter()
            .map(|pose| {
                let [a, b] = task.mounts.map(|mount| self.place(mount, pose));
                b.seen_from(&a)
            })
            .collect();
        let pose = poses.first()?.pose.into();
        let mut least: Option<Near> = None;
        task.solids.retain(|solid| {
            let Some(mm) = solid.pinned(&places) else {
                return true;
            };
            if least.as_ref().is_none_or(|least| mm < least.proved) {
                let [first, second] = solid.bodies.map(|body| self.bodies()[body].name.clone());
                least = Some(Near {
                    seen: Some(Clearance {
                        first: first.clone(),
                        second: second.clone(),
                        pose,
                        mm,
                    }),
                    first,
                    second,
                    proved: mm,
                    doubt: None,
                });
            }
            false
        });
        least
    }

    fn near(&self, found: Found) -> Near {
        let [first, second] = found.bodies.map(|body| self.bodies()[body].name.clone());
        let servos = self.robot().servos();
        Near {
            seen: found.seen.map(|(pose, mm)| Clearance {
                first: first.clone(),
                second: second.clone(),
                pose: pose.pose.into(),
                mm,
            }),
            doubt: found.doubt.map(|angles| {
                [0, 1, 2, 3].map(|servo| angles[servo].unwrap_or(servos[servo].neutral))
            }),
            first,
            second,
            proved: found.proved,
        }
    }
}
