//! Proof that no two parts collide at any pose that the guard accepts.
//!
//! The proof does not sample poses. It divides the space of the servos' angles into regions. For each region it shows
//! either that the guard accepts no pose in the region, or that the parts stay apart in the whole region: their
//! distance is measured at the region's centre, and no point moves by more than its largest rate times the region's
//! half width. The rates come from the mechanism's closed forms in interval arithmetic (`interval.rs`,
//! `interval_dual.rs`), which also holds for a coupler near a singularity. A region that is too large for either proof
//! is halved (`search.rs`).
//!
//! The relative position of two parts depends only on the servos of their mounts
//! ([`Mount::servos`](crate::Mount::servos)): one or two, rarely three. The whole proof therefore takes only seconds.
//! `shape_pairs.rs` lists the pairs of shapes that must stay clear, `bounding_rectangles.rs` excludes pairs that are
//! never close, and `guard.rs` finds the regions that the guard certainly refuses.

mod bounding_rectangles;
pub(crate) mod clearance;
mod guard;
mod interval;
mod interval_dual;
mod quick_check;
mod search;
mod shape_pairs;

use std::fmt;

use lizard_kinematics::Solution;
use serde::{Deserialize, Serialize};

use crate::bodies::assembly::Assembly;
use crate::layers::body::Body;
use crate::proof::clearance::Clearance;
use guard::RelaxedGuard;
pub use search::FAR_MM;
use shape_pairs::Task;

/// Smallest allowed distance between parts that are not designed to touch, mm: more than a printer's error.
pub const MIN_GAP_MM: f64 = 0.2;
/// Largest overlap of parts designed to touch that still counts as touching, mm.
const TOUCH_OVERLAP: f64 = 0.02;

/// Number of angles per servo in the grid of poses that shows which pairs are pinned to each other, like a pin and its
/// hole.
const JOINT_GRID_ANGLES: u32 = 6;

/// Two bodies and their smallest distance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NearestPair {
    /// Name of one body.
    pub first: String,
    /// Name of the other body.
    pub second: String,
    /// Lower bound of the bodies' distance over all accepted poses, mm; below 0 the bodies may overlap.
    #[serde(rename = "proved")]
    pub lower_bound: f64,
    /// Accepted pose with nearly the distance `lower_bound`; `None` if the bodies come no closer than [`FAR_MM`], or if
    /// no such pose is found.
    #[serde(rename = "seen")]
    pub witness: Option<Clearance>,
    /// Servo angles near which no larger distance could be proved, deg; `None` if `lower_bound` is close to the
    /// distance in `witness`. The angles are near the guard's limits, or just beyond.
    #[serde(rename = "doubt")]
    pub unproved_angles: Option<[f64; 4]>,
}

/// A proof that a robot's parts keep clear of each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Proof {
    /// The nearest two bodies of each pair of mounts, without bodies that are designed to touch, by ascending distance.
    pub separate_pairs: Vec<NearestPair>,
    /// The nearest two bodies of each pair of mounts among bodies that are designed to touch, such as a pin and its
    /// hole; their distance is the gap.
    pub touching_pairs: Vec<NearestPair>,
    /// Bounds of each servo's angle over all accepted poses, deg.
    pub ranges: [[f64; 2]; 4],
    /// Number of pairs of shapes checked.
    pub shape_pair_count: usize,
    /// Number of regions of poses checked.
    pub region_count: u64,
}

/// Two parts that do not stay clear of each other.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Clash {
    /// Two parts that overlap.
    #[error("{0}")]
    Overlap(Box<Clearance>),
    /// Two parts that come too close to each other.
    #[error("{0}, which is less than {MIN_GAP_MM} mm")]
    Narrow(Box<Clearance>),
    /// Two parts that may overlap at poses near the guard's limits, or just beyond.
    #[error("{0}")]
    Unproved(Box<NearestPair>),
}

impl fmt::Display for NearestPair {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (first, second, bound) = (&self.first, &self.second, self.lower_bound);
        write!(f, "{first} and {second} ")?;
        let Some([a, b, c, d]) = self.unproved_angles else {
            return write!(f, "are at least {bound:.2} mm apart");
        };
        match bound < 0.0 {
            true => write!(f, "may overlap by {:.2} mm", -bound)?,
            false => write!(f, "may come as near as {bound:.2} mm")?,
        }
        write!(f, " near pose {a:.2} {b:.2} {c:.2} {d:.2}")
    }
}

impl NearestPair {
    /// Returns the clash of the bodies if they come, or may come, closer than `min_mm`; otherwise `None`.
    fn clash(&self, min_mm: f64) -> Option<Clash> {
        match &self.witness {
            Some(clearance) if clearance.mm < min_mm.min(0.0) => {
                Some(Clash::Overlap(Box::new(clearance.clone())))
            }
            Some(clearance) if clearance.mm < min_mm => {
                Some(Clash::Narrow(Box::new(clearance.clone())))
            }
            _ if self.lower_bound < min_mm => Some(Clash::Unproved(Box::new(self.clone()))),
            _ => None,
        }
    }

    /// Distance in `witness`, mm; the proved bound if `witness` is `None`.
    fn min_distance(&self) -> f64 {
        let witness = self.witness.as_ref();
        witness.map_or(self.lower_bound, |clearance| clearance.mm)
    }
}

impl Proof {
    /// Decides whether the parts fit.
    ///
    /// # Errors
    /// Returns the worst pair: parts that overlap, come closer than [`MIN_GAP_MM`], or have no proof of this distance.
    pub fn check(&self) -> Result<(), Clash> {
        let separate_pairs = self.separate_pairs.iter();
        let touching_pairs = self.touching_pairs.iter();
        let pairs = separate_pairs.map(|pair| (pair, MIN_GAP_MM));
        let pairs = pairs.chain(touching_pairs.map(|pair| (pair, -TOUCH_OVERLAP)));
        let clashes =
            pairs.filter_map(|(pair, min_mm)| Some((pair.clash(min_mm)?, pair.min_distance())));
        let worst_clash = clashes.min_by(|(_, a), (_, b)| a.total_cmp(b));
        worst_clash.map_or(Ok(()), |(clash, _)| Err(clash))
    }
}

/// The tasks of a proof. Each task finds the smallest distance between the bodies of two mounts. The tasks are
/// independent, so other machines can complete them.
pub struct ProofTasks<'a> {
    assembly: &'a Assembly,
    guard: RelaxedGuard<'a>,
    tasks: Vec<Task>,
    /// True if the quick check found parts that come too close; `tasks` then holds only the worst tasks.
    has_clash: bool,
    /// Accepted poses at which the proof tests whether pairs are pinned to each other.
    joint_poses: Vec<Solution>,
}

/// The result of a task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TaskResult {
    /// Pinned pair with the smallest gap; `None` if no pair is pinned.
    pinned: Option<NearestPair>,
    /// Nearest pair that is not pinned, and the number of checked regions of poses; `None` if all pairs are pinned.
    nearest: Option<(NearestPair, u64)>,
}

impl<'a> ProofTasks<'a> {
    /// Collects the tasks for the pairs of bodies that `is_chosen` accepts.
    pub fn new(assembly: &'a Assembly, is_chosen: impl Fn(&Body, &Body) -> bool) -> Self {
        let guard = RelaxedGuard::new(assembly.robot());
        let tasks = Task::collect(assembly, &guard, FAR_MM, is_chosen);
        let clashing_tasks = quick_check::find_worst_tasks(assembly, &tasks);
        Self {
            has_clash: clashing_tasks.is_some(),
            tasks: clashing_tasks.unwrap_or(tasks),
            joint_poses: assembly.grid_poses(JOINT_GRID_ANGLES).collect(),
            guard,
            assembly,
        }
    }

    /// Number of tasks.
    pub fn count(&self) -> usize {
        self.tasks.len()
    }

    /// Completes the task with an index below [`ProofTasks::count`].
    pub fn complete_one(&self, index: usize) -> TaskResult {
        self.complete_within(index, search::MAX_REGIONS)
    }

    /// Completes a task; checks at most `max_regions` regions.
    fn complete_within(&self, index: usize, max_regions: u64) -> TaskResult {
        let (assembly, mut task) = (self.assembly, self.tasks[index].clone());
        let pinned = match task.may_touch {
            true => assembly.remove_pinned_pairs(&mut task, &self.joint_poses),
            false => None,
        };
        let nearest = (!task.shape_pairs.is_empty())
            .then(|| search::find_nearest_pair(assembly, &self.guard, &task, max_regions));
        TaskResult { pinned, nearest }
    }

    /// Completes all tasks and composes the proof. `known_result` returns the result of an earlier call of
    /// [`ProofTasks::complete_one`] for an index. The proof ends at the first parts that do not fit, unless the quick
    /// check has found such parts: then each of its worst pairs is bounded. After parts that may not fit, the remaining
    /// tasks are completed with fewer regions and without `known_result`. `progress` is called as in
    /// [`Assembly::prove`].
    pub fn complete_all(
        &self,
        mut known_result: impl FnMut(usize) -> Option<TaskResult>,
        mut progress: impl FnMut(usize, usize),
    ) -> Proof {
        let mut max_regions = search::MAX_REGIONS;
        let mut proof = Proof {
            separate_pairs: Vec::new(),
            touching_pairs: Vec::new(),
            ranges: self.guard.ranges.map(|range| [range.low, range.high]),
            shape_pair_count: self.tasks.iter().map(|task| task.shape_pairs.len()).sum(),
            region_count: 0,
        };
        let count = self.count();
        for (index, task) in self.tasks.iter().enumerate() {
            progress(index, count);
            let result = match max_regions {
                search::MAX_REGIONS => {
                    known_result(index).unwrap_or_else(|| self.complete_one(index))
                }
                fewer_regions => self.complete_within(index, fewer_regions),
            };
            proof.touching_pairs.extend(result.pinned);
            let Some((nearest_pair, region_count)) = result.nearest else {
                continue;
            };
            proof.region_count += region_count;
            let clash = nearest_pair.clash(task.required_gap());
            if task.may_touch {
                proof.touching_pairs.push(nearest_pair);
            } else {
                proof.separate_pairs.push(nearest_pair);
            }
            // One clash is enough to refuse the robot. Tasks with parts that barely fit take long.
            match clash {
                Some(Clash::Unproved(_)) => max_regions = search::MAX_REGIONS / 10,
                Some(_) if !self.has_clash => break,
                _ => {}
            }
        }
        progress(count, count);
        for pairs in [&mut proof.separate_pairs, &mut proof.touching_pairs] {
            pairs.sort_by(|a, b| a.lower_bound.total_cmp(&b.lower_bound));
        }
        proof
    }
}

impl Assembly {
    /// Bounds the distance between any two parts over all accepted poses; [`Proof::check`] then decides whether the
    /// parts fit. If some parts come too close at a pose of the quick check, only the worst of them are bounded;
    /// otherwise the proof ends at the first parts that do not fit. `progress` is called with the number of completed
    /// tasks and the number of all tasks.
    pub fn prove(&self, progress: impl FnMut(usize, usize)) -> Proof {
        self.prove_chosen(|_, _| true, progress)
    }

    /// Bounds the distances as [`Assembly::prove`] does, for the pairs of bodies that `is_chosen` accepts.
    pub fn prove_chosen(
        &self,
        is_chosen: impl Fn(&Body, &Body) -> bool,
        progress: impl FnMut(usize, usize),
    ) -> Proof {
        ProofTasks::new(self, is_chosen).complete_all(|_| None, progress)
    }

    /// Removes the pinned pairs from a task and returns the pair with the smallest gap; `None` if there are no pinned
    /// pairs or no poses. A pin and its round hole have the same centre at every pose, so their gap is constant.
    fn remove_pinned_pairs(&self, task: &mut Task, poses: &[Solution]) -> Option<NearestPair> {
        let relative_placement = |pose| {
            let [a, b] = task.mounts.map(|mount| self.placement(mount, pose));
            b.relative_to(&a)
        };
        let placements: Vec<_> = poses.iter().map(relative_placement).collect();
        let pose = *poses.first()?;
        let mut pinned_pairs = Vec::new();
        task.shape_pairs.retain(|pair| {
            let gap = pair.compute_pinned_gap(&placements);
            pinned_pairs.extend(gap.map(|mm| (mm, pair.bodies)));
            gap.is_none()
        });
        let pinned_pairs = pinned_pairs.into_iter();
        let (mm, bodies) = pinned_pairs.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
        Some(self.make_nearest_pair(bodies, mm, Some((pose, mm)), None))
    }

    /// Makes the result for two bodies, given as indices in [`Assembly::bodies`]. `lower_bound` is a bound of their
    /// distance, mm; `nearest` is an accepted pose with the distance at this pose, mm; `unproved_angles` are angles of
    /// some servos near which no larger distance could be proved. Angles without effect on the distance become neutral.
    fn make_nearest_pair(
        &self,
        bodies: [usize; 2],
        lower_bound: f64,
        nearest: Option<(Solution, f64)>,
        unproved_angles: Option<[Option<f64>; 4]>,
    ) -> NearestPair {
        let [first, second] = bodies.map(|body| self.bodies()[body].name.clone());
        let neutral = self.robot().servos().each_ref().map(|servo| servo.neutral);
        let fill_angles = |optional_angles: [Option<f64>; 4]| {
            std::array::from_fn(|i| optional_angles[i].unwrap_or(neutral[i]))
        };
        NearestPair {
            witness: nearest.map(|(pose, mm)| Clearance {
                first: first.clone(),
                second: second.clone(),
                pose: pose.pose.into(),
                mm,
            }),
            unproved_angles: unproved_angles.map(fill_angles),
            first,
            second,
            lower_bound,
        }
    }
}
