//! Reasons why a robot cannot be built, and the checks that find them.

use lizard_kinematics::Vector;
use serde::Serialize;

use crate::bodies::assembly::Assembly;
use crate::bodies::pads;
use crate::bodies::sliders::{SliderLengths, slider_range};
use crate::layers::body::{Body, Kind, Prism};
use crate::layers::shape::Shape;
use crate::order::reach::BlockedScrew;
use crate::order::steps::steps;
use crate::proof::Clash;

/// A reason why a robot cannot be built, as the message that the user sees.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BuildProblem {
    /// Two parts that collide or come too near each other.
    #[error(
        "{0}; other links, or other dimensions under [parts] in robot.toml, may keep them apart"
    )]
    Clash(#[from] Clash),
    /// Two parts that move together and overlap.
    #[error(
        "{first} and {second}, which move together, overlap by {mm:.2} mm; other links, or other dimensions under \
         [parts] in robot.toml, may keep them apart"
    )]
    OverlapOnMount {
        /// Name of one body.
        first: String,
        /// Name of the other body.
        second: String,
        /// Their overlap, mm.
        mm: f64,
    },
    /// A message about a dimension in robot.toml with which the parts cannot be made.
    #[error("{0}")]
    Dimension(String),
    /// A screw that cannot be reached.
    #[error(
        "{0}, at every pose; other links, or other dimensions under [parts] in robot.toml, may make room"
    )]
    Blocked(#[from] BlockedScrew),
    /// The name of a part whose layers do not form a single closed body.
    #[error(
        "the layers of {0} do not make one body; a dimension under [parts] in robot.toml is too small or too large for it"
    )]
    OpenSurface(String),
}

/// The two parts whose collision is the reason why a robot cannot be built.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CollidingPair {
    /// Name of one body.
    pub first: String,
    /// Name of the other body.
    pub second: String,
    /// Their distance, mm; negative if they overlap.
    pub mm: f64,
    /// Servo angles at that distance, deg, servo order; `None` if the bodies overlap at every pose, or if no pose is
    /// known.
    pub pose: Option<[f64; 4]>,
}

impl BuildProblem {
    /// The parts that collide or may collide; `None` if the robot cannot be built for another reason.
    #[must_use]
    pub fn colliding_pair(&self) -> Option<CollidingPair> {
        match self {
            Self::Clash(Clash::Overlap(clearance) | Clash::Narrow(clearance)) => {
                Some(CollidingPair {
                    first: clearance.first.clone(),
                    second: clearance.second.clone(),
                    mm: clearance.mm,
                    pose: Some(clearance.pose),
                })
            }
            Self::Clash(Clash::Unproved(pair)) => Some(CollidingPair {
                first: pair.first.clone(),
                second: pair.second.clone(),
                mm: pair.lower_bound,
                pose: pair.unproved_angles,
            }),
            Self::OverlapOnMount { first, second, mm } => Some(CollidingPair {
                first: first.clone(),
                second: second.clone(),
                mm: -mm,
                pose: None,
            }),
            Self::Dimension(_) | Self::Blocked(_) | Self::OpenSurface(_) => None,
        }
    }
}

/// Least gap between servos and floor, mm.
const MIN_SERVO_FLOOR_GAP: f64 = 8.0;
/// The shortest sleeve that guides a rod, mm.
const MIN_SLEEVE_LENGTH: f64 = 25.0;

/// The message for a crank that is too thin for the nut in it.
const NUT_MESSAGE: &str = "the nut of a leg's anchor does not fit into its crank with a screw from the shop; \
                   raise parts.thickness or the servo's horn";

impl Assembly {
    /// Checks that the robot can be built: that its dimensions are consistent, that no two parts collide at any pose
    /// that the guard accepts, and that every screw can be reached. The collision proof takes seconds.
    ///
    /// # Errors
    /// Returns the first dimension that does not fit, else the two parts that overlap most, else a screw that
    /// cannot be reached.
    pub fn check_fit(&self) -> Result<(), BuildProblem> {
        self.check_dimensions()?;
        self.prove(|_, _| ()).judge()?;
        self.access_poses(&steps(self.robot().drive().strut().is_some()))?;
        Ok(())
    }

    /// Checks that the dimensions in robot.toml are consistent.
    ///
    /// # Errors
    /// Returns the first dimension that does not fit.
    pub fn check_dimensions(&self) -> Result<(), BuildProblem> {
        let (robot, stack) = (self.robot(), self.stack());
        let (parts, drive) = (robot.parts(), robot.drive());
        let refuse = |message: String| Err(BuildProblem::Dimension(message));
        let min_bar_mm = parts.screw.head + 2.0 * parts.fit + 1.2;
        if parts.bar < min_bar_mm {
            return refuse(format!(
                "parts.bar is {} mm, but the head of a screw and a wall on each side need {min_bar_mm:.1} mm",
                parts.bar
            ));
        }
        if !stack.crank_holds_nut(parts) {
            return refuse(NUT_MESSAGE.to_owned());
        }
        for (measure, actual, min) in [
            ("height", parts.pad.height, pads::min_height(parts)),
            ("width", parts.pad.width, pads::min_width(parts)),
        ] {
            if actual < min {
                return refuse(format!(
                    "parts.pad.{measure} is {actual} mm; a pad with a screw's head in it needs {min:.1} mm"
                ));
            }
        }
        let [min, max] = pads::strip_widths(parts);
        if parts.strip > 0.0 && !(min..=max).contains(&parts.strip) {
            return refuse(format!(
                "parts.strip is {} mm; a pad of parts.pad.width {} mm takes a strip of {min:.1} to {max:.1} mm, or 0 for none",
                parts.strip, parts.pad.width
            ));
        }
        if parts
            .pad
            .dome_height()
            .is_none_or(|dome| dome > parts.pad.height)
        {
            return refuse(format!(
                "a dome of parts.pad.radius {} mm is narrower or higher than parts.pad.width {} mm and height {} mm \
                 allow; raise the radius",
                parts.pad.radius, parts.pad.width, parts.pad.height
            ));
        }
        let min_height_mm = MIN_SERVO_FLOOR_GAP - stack.servo_bottom;
        if parts.height < min_height_mm {
            return refuse(format!(
                "parts.height is {} mm; the feet need {min_height_mm:.1} mm to keep the servos off the floor",
                parts.height
            ));
        }
        if drive.strut().is_some() && robot.mounted_spring_length() <= parts.spring.free_length {
            return refuse(format!(
                "leg strut {} is {:.1} mm from screw to screw, but its spring is {:.1} mm long inside its hooks \
                 without load and must be pulled; parts.pivot sets the one, parts.spring.length the other; \
                 [leg.drive] kind = \"rigid\" needs no spring",
                lizard_robot::servo::LEG_NAMES[0],
                self.layout().legs[0].strut_length,
                parts.spring.free_length
            ));
        }
        for side in lizard_kinematics::Side::ALL {
            let range = slider_range(robot, side);
            if SliderLengths::new(side, range).sleeve < MIN_SLEEVE_LENGTH {
                let [shortest_mm, longest_mm] = range;
                return refuse(format!(
                    "the {side} slider is {shortest_mm:.1} mm at its shortest and {longest_mm:.1} mm at its longest; a rod \
                     that stays in its sleeve does not fit between: raise limits.stroke_min or lower limits.stroke_max"
                ));
            }
        }
        for body in self.bodies() {
            if let Kind::Screw(length) | Kind::HexScrew(length) = body.kind
                && !crate::layers::stack::is_screw_sold(length)
            {
                return refuse(format!(
                    "{} would have to be {length:.1} mm long, which no shop has; lower parts.thickness or parts.plate",
                    body.name
                ));
            }
            if body.prisms.iter().any(|prism| prism.z[1] <= prism.z[0]) {
                return Err(BuildProblem::OpenSurface(body.name.clone()));
            }
        }
        self.check_overlaps()
    }

    /// Checks that no two bodies that move together overlap.
    fn check_overlaps(&self) -> Result<(), BuildProblem> {
        /// Overlap allowed for press fits, mm.
        const PRESS_FIT_OVERLAP: f64 = 0.02;
        let bodies = self.bodies();
        for (i, a) in bodies.iter().enumerate() {
            for b in bodies[i + 1..].iter().filter(|b| b.mount == a.mount) {
                let gap_mm =
                    layer_clearance(self.layers_without_thread(a), self.layers_without_thread(b));
                if gap_mm < -PRESS_FIT_OVERLAP {
                    return Err(BuildProblem::OverlapOnMount {
                        first: a.name.clone(),
                        second: b.name.clone(),
                        mm: -gap_mm,
                    });
                }
            }
        }
        Ok(())
    }

    /// The layers of a body that may not overlap others: only the head of a screw without a nut, which cuts its own
    /// thread; else all layers.
    fn layers_without_thread<'a>(&self, body: &'a Body) -> &'a [Prism] {
        let nut_name = body.name.replacen("screw", "nut", 1);
        match (body.kind, &body.prisms[..]) {
            (Kind::Screw(_) | Kind::HornScrew(_), [low, high])
                if self.body(&nut_name).is_none() =>
            {
                let is_head_above =
                    high.filled_shapes[0].diameter() > low.filled_shapes[0].diameter();
                &body.prisms[usize::from(is_head_above)..][..1]
            }
            (_, layers) => layers,
        }
    }
}

/// The least distance in plan view between layers of two bodies at a height that they share, mm; negative if they
/// overlap. A shape is clear of a layer if it lies beside the layer's shapes or inside one of its holes.
fn layer_clearance(a: &[Prism], b: &[Prism]) -> f64 {
    let gap_to_layer = |shape: &Shape, holes: &[Shape], gap_beside: f64| {
        let depths = holes
            .iter()
            .map(|hole| shape.depth_in(hole, Vector::default()));
        depths.fold(gap_beside, f64::max)
    };
    let mut least_gap = f64::INFINITY;
    let layers = a.iter().flat_map(|p| b.iter().map(move |q| (p, q)));
    for (p, q) in layers.filter(|(p, q)| p.z[0] <= q.z[1] - 1e-6 && q.z[0] <= p.z[1] - 1e-6) {
        for first in &p.filled_shapes {
            for second in &q.filled_shapes {
                let gap = gap_to_layer(first, &q.cut_shapes, first.distance(second));
                least_gap = least_gap.min(gap_to_layer(second, &p.cut_shapes, gap));
            }
        }
    }
    least_gap
}
