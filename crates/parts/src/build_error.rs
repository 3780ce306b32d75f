//! The reasons why a robot cannot be built, and the checks that find them.

use lizard_kinematics::Vector;
use serde::Serialize;

use crate::bodies::assembly::Assembly;
use crate::bodies::pads;
use crate::bodies::sliders::{SliderLengths, compute_slider_range};
use crate::layers::body::{Body, Kind, Prism};
use crate::layers::fitting::Fitting;
use crate::layers::shape::Shape;
use crate::order::reach::BlockedScrew;
use crate::order::steps::build_steps;
use crate::proof::Clash;

/// A reason why a robot cannot be built, as the user's message.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BuildError {
    /// Two parts that collide or come too close to each other.
    #[error(
        "{0}; other links, or other dimensions under [parts] in robot.toml, may keep them apart"
    )]
    Clash(#[from] Clash),
    /// Two parts that overlap and move together.
    #[error("{first} and {second}, which move together, overlap by {mm:.2} mm; {advice}")]
    OverlapOnMount {
        /// Name of one body.
        first: String,
        /// Name of the other body.
        second: String,
        /// Overlap of the bodies, mm.
        mm: f64,
        /// Change that may keep the bodies apart, as the end of the message.
        advice: &'static str,
    },
    /// A dimension in robot.toml with which the parts cannot be made, as a message.
    #[error("{0}")]
    Dimension(String),
    /// A screw that cannot be reached.
    #[error(
        "{0}, at every pose that was tried; other links, or other dimensions under [parts] in robot.toml, may make room"
    )]
    Blocked(#[from] BlockedScrew),
    /// A part, by name, whose layers do not form a single closed body.
    #[error(
        "the layers of {0} do not form one body; one of its dimensions under [parts] in robot.toml is too small or too large"
    )]
    OpenSurface(String),
}

/// Two parts that do not stay clear of each other, so the robot cannot be built.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CollidingPair {
    /// Name of one body.
    pub first: String,
    /// Name of the other body.
    pub second: String,
    /// Distance between the bodies, mm; negative if they overlap. For an unproved pair, the distance's lower bound.
    pub mm: f64,
    /// Servo angles at that distance, deg, servo order; `None` if no pose is known or the bodies overlap at every pose.
    pub pose: Option<[f64; 4]>,
}

impl BuildError {
    /// The parts that overlap, come too close, or may overlap; `None` if the error has another reason.
    pub fn colliding_pair(&self) -> Option<CollidingPair> {
        let (first, second, mm, pose) = match self {
            Self::Clash(Clash::Overlap(pair) | Clash::Narrow(pair)) => {
                (&pair.first, &pair.second, pair.mm, Some(pair.pose))
            }
            Self::Clash(Clash::Unproved(pair)) => {
                let (mm, angles) = (pair.lower_bound, pair.unproved_angles);
                (&pair.first, &pair.second, mm, angles)
            }
            Self::OverlapOnMount {
                first, second, mm, ..
            } => (first, second, -mm, None),
            Self::Dimension(_) | Self::Blocked(_) | Self::OpenSurface(_) => return None,
        };
        Some(CollidingPair {
            first: first.clone(),
            second: second.clone(),
            mm,
            pose,
        })
    }
}

/// Smallest allowed gap between servos and floor, mm.
const MIN_SERVO_FLOOR_GAP: f64 = 8.0;
/// The shortest sleeve that guides a rod, mm.
const MIN_SLEEVE_LENGTH: f64 = 25.0;

/// The message for a crank that is too thin for its nut.
const THIN_CRANK_MESSAGE: &str =
    "the nut of a leg's anchor does not fit into its crank; increase parts.thickness";

impl Assembly {
    /// Checks that the robot can be built: its dimensions are consistent, no two parts collide at any pose that the
    /// guard accepts, and every screw can be reached. The collision proof takes seconds.
    ///
    /// # Errors
    /// Returns the first error of [`Self::check_dimensions`], the two parts that clash worst, or a screw without
    /// access.
    pub fn check_fit(&self) -> Result<(), BuildError> {
        self.check_dimensions()?;
        self.prove(|_, _| ()).check()?;
        self.find_access_poses(&build_steps(self.robot().drive().strut().is_some()))?;
        Ok(())
    }

    /// Checks that the dimensions in robot.toml are consistent.
    ///
    /// # Errors
    /// Returns the first dimension that does not fit, a part whose layers do not form one body, or two parts that
    /// overlap and move together.
    pub fn check_dimensions(&self) -> Result<(), BuildError> {
        let (robot, stack) = (self.robot(), self.stack());
        let (parts, drive) = (robot.parts(), robot.drive());
        let refuse = |message: String| Err(BuildError::Dimension(message));
        let min_bar_mm = parts.screw.head + 2.0 * parts.fit + 1.2;
        if parts.bar < min_bar_mm {
            return refuse(format!(
                "parts.bar must be at least {min_bar_mm:.1} mm for a screw's head and a wall on each side, but is {} mm",
                parts.bar
            ));
        }
        if !stack.crank_holds_nut(parts) {
            return refuse(THIN_CRANK_MESSAGE.to_owned());
        }
        for (key, actual, min) in [
            ("height", parts.pad.height, pads::min_height(parts)),
            ("width", parts.pad.width, pads::min_width(parts)),
        ] {
            if actual < min {
                return refuse(format!(
                    "parts.pad.{key} must be at least {min:.1} mm for a screw's head in the pad, but is {actual} mm"
                ));
            }
        }
        let [min, max] = pads::strip_width_range(parts);
        if parts.strip > 0.0 && !(min..=max).contains(&parts.strip) {
            return refuse(format!(
                "parts.strip must be 0 (no strip) or between {min:.1} and {max:.1} mm for a parts.pad.width of {} mm, but is {} mm",
                parts.pad.width, parts.strip
            ));
        }
        let is_too_high = |dome_height: f64| dome_height > parts.pad.height;
        if parts.pad.dome_height().is_none_or(is_too_high) {
            return refuse(format!(
                "a dome with a parts.pad.radius of {} mm does not fit parts.pad.width = {} mm and parts.pad.height = {} mm; \
                 increase the radius",
                parts.pad.radius, parts.pad.width, parts.pad.height
            ));
        }
        let min_height_mm = MIN_SERVO_FLOOR_GAP - stack.servo_bottom;
        if parts.height < min_height_mm {
            return refuse(format!(
                "parts.height must be at least {min_height_mm:.1} mm to keep the servos off the floor, but is {} mm",
                parts.height
            ));
        }
        if drive.strut().is_some() && robot.mounted_spring_length() <= parts.spring.free_length {
            return refuse(format!(
                "leg strut {} is {:.1} mm from screw to screw, but must be long enough to stretch its spring, which is \
                 {:.1} mm long inside its hooks without load; change parts.pivot or parts.spring.length, or set \
                 kind = \"rigid\" under [leg.drive], which needs no spring",
                lizard_robot::servo::LEG_NAMES[0],
                self.layout().legs[0].strut_length,
                parts.spring.free_length
            ));
        }
        for side in lizard_kinematics::Side::ALL {
            let range = compute_slider_range(robot, side);
            if SliderLengths::new(side, range).sleeve < MIN_SLEEVE_LENGTH {
                let [shortest_mm, longest_mm] = range;
                return refuse(format!(
                    "the {side} slider is {shortest_mm:.1} to {longest_mm:.1} mm long, a range for which no rod stays in its \
                     sleeve; increase limits.stroke_min or decrease limits.stroke_max"
                ));
            }
        }
        for body in self.bodies() {
            if let Kind::Screw(length) | Kind::HexScrew(length) = body.kind
                && !crate::layers::stack::is_common_screw_length(length)
            {
                return refuse(format!(
                    "{} must be {length:.1} mm long, which is not a standard length; change parts.thickness or parts.plate",
                    body.name
                ));
            }
            if body.prisms.iter().any(|prism| prism.z[1] <= prism.z[0]) {
                return Err(BuildError::OpenSurface(body.name.clone()));
            }
        }
        self.check_overlaps()
    }

    /// Checks that no two bodies that move together overlap.
    fn check_overlaps(&self) -> Result<(), BuildError> {
        /// Overlap allowed for press fits, mm.
        const PRESS_FIT_OVERLAP: f64 = 0.02;
        let bodies = self.bodies();
        for (i, a) in bodies.iter().enumerate() {
            for b in bodies[i + 1..].iter().filter(|b| b.mount == a.mount) {
                let [a_layers, b_layers] = [a, b].map(|body| self.layers_without_thread(body));
                let gap_mm = compute_min_layer_gap(a_layers, b_layers);
                if gap_mm < -PRESS_FIT_OVERLAP {
                    return Err(BuildError::OverlapOnMount {
                        first: a.name.clone(),
                        second: b.name.clone(),
                        mm: -gap_mm,
                        advice: choose_overlap_advice(a, b),
                    });
                }
            }
        }
        Ok(())
    }

    /// The layers of a body that must not overlap others: all its layers, or only the head of a screw that is added
    /// without a nut, since another body has the thread for it.
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

/// Chooses the advice for two overlapping bodies that move together.
fn choose_overlap_advice(a: &Body, b: &Body) -> &'static str {
    let kinds = [a.kind, b.kind];
    let is_on_battery = |kind: Kind| {
        matches!(
            kind,
            Kind::Battery | Kind::Fitting(Fitting::Strap | Fitting::BatteryPlug)
        )
    };
    let is_under_deck =
        |kind: Kind| matches!(kind, Kind::Fitting(Fitting::Alarm | Fitting::Converter));
    if kinds.into_iter().any(is_on_battery) && kinds.into_iter().any(is_under_deck) {
        return "decrease the height of parts.battery, or raise the deck with a larger parts.thickness or parts.fit";
    }
    "other links, or other dimensions under [parts] in robot.toml, may keep them apart"
}

/// Computes the smallest distance in plan view between layers of two bodies at a common height, mm; negative if they
/// overlap. A shape is clear of a layer if it lies beside the layer's shapes or inside one of the layer's holes.
fn compute_min_layer_gap(a: &[Prism], b: &[Prism]) -> f64 {
    let shape_gap = |shape: &Shape, holes: &[Shape], gap_beside: f64| {
        let holes = holes.iter();
        let depths = holes.map(|hole| shape.depth_in(hole, Vector::default()));
        depths.fold(gap_beside, f64::max)
    };
    let mut min_gap = f64::INFINITY;
    let pairs = a.iter().flat_map(|p| b.iter().map(move |q| (p, q)));
    for (p, q) in pairs.filter(|(p, q)| p.z[0] <= q.z[1] - 1e-6 && q.z[0] <= p.z[1] - 1e-6) {
        for first in &p.filled_shapes {
            for second in &q.filled_shapes {
                let gap = shape_gap(first, &q.cut_shapes, first.distance(second));
                min_gap = min_gap.min(shape_gap(second, &p.cut_shapes, gap));
            }
        }
    }
    min_gap
}
