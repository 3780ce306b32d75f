//! The order in which the robot is put together, from the plate to the first walk.
//!
//! A step is one picture of the guide. Within a step the hands do one thing after
//! another, some of it on the bench before it is mounted on the robot. These are the
//! stages of the step, and `reach.rs` checks which screws can be reached in which stage.
//!
//! A servo does not report its angle. So it is wired and driven to its middle before its
//! link is pressed on, and its direction is tested before anything joins the links: then
//! a link that turns the wrong way moves only itself.

use crate::layers::body::{Body, Kind, Mount};

/// One step of the guide.
pub struct Step {
    /// The headline.
    pub title: &'static str,
    /// The instructions, as Markdown.
    pub words: &'static str,
    /// The bodies to add, in stages; none for a step at the console.
    pub stages: Vec<Stage>,
    /// Lift of a body in the exploded picture, as a share.
    pub lift: fn(&Body) -> f64,
    /// An extra picture, if any.
    pub near: Near,
}

/// A picture besides the two of the complete robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Near {
    /// No extra picture.
    None,
    /// The front left corner alone.
    Corner,
    /// The front left corner, from below.
    CornerBelow,
    /// The complete robot, from below.
    Below,
}

/// Bodies that are added together.
pub struct Stage {
    /// The place where its screws are turned.
    pub at: Where,
    /// True for a body that the stage adds, unless an earlier stage has added it.
    pub adds: fn(&Body) -> bool,
}

/// The place where the screws of a stage are turned.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Where {
    /// On the robot, among all bodies added before.
    Robot,
    /// On the bench, among the bodies of the same servo that this step has added.
    Bench,
}

impl Step {
    /// True if a body is added in this step.
    pub fn adds(&self, body: &Body) -> bool {
        self.stages.iter().any(|stage| (stage.adds)(body))
    }
}

/// The step in which a body is added and the stage of that step, each from 1; zeros for a body
/// that none adds.
pub(crate) fn place_in(steps: &[Step], body: &Body) -> (usize, usize) {
    for (step, of) in (1..).zip(steps) {
        if let Some(stage) = of.stages.iter().position(|stage| (stage.adds)(body)) {
            return (step, stage + 1);
        }
    }
    (0, 0)
}

fn named(body: &Body, starts: &[&str]) -> bool {
    starts.iter().any(|start| body.name.starts_with(start))
}

fn robot(adds: fn(&Body) -> bool) -> Stage {
    let at = Where::Robot;
    Stage { at, adds }
}

fn bench(adds: fn(&Body) -> bool) -> Stage {
    let at = Where::Bench;
    Stage { at, adds }
}

/// A step at the console, which adds no bodies.
fn console(title: &'static str, words: &'static str) -> Step {
    Step {
        title,
        words,
        stages: Vec::new(),
        lift: |_| 0.0,
        near: Near::None,
    }
}

/// The steps of a robot with slotted or with rigid struts.
pub fn steps(slotted: bool) -> Vec<Step> {
    vec![
        chassis(),
        supply(),
        board(),
        flash(),
        links(),
        signs(),
        legs(),
        legs_on_plate(),
        struts(slotted),
        sliders(),
        ends(),
        level(),
        walk(),
    ]
}

fn chassis() -> Step {
    Step {
        title: "Servos and standoffs",
        words: "Lay the plate down with its raised seats up. The end with the engraved 1 and 2 is the head; 1 to 4 are the places of the \
                servos A1 to A4. Leave the horns off. Push each servo from above into its opening, plug and lead first, the shaft towards \
                the near end of the plate: the lead passes through the notch there. Fix it with the two self-tapping screws of its bag. \
                Fold the lead below the plate around the case, between the servos, and up through the hole between the standoffs. Screw the \
                four standoffs on from below.",
        stages: vec![robot(|body| {
            body.name == "plate"
                || matches!(
                    body.kind,
                    Kind::Servo | Kind::ServoScrew | Kind::Standoff(_) | Kind::Lead
                )
                || (body.name.starts_with("screw standoff") && body.name.ends_with("below"))
        })],
        lift: |body| match body.kind {
            Kind::Printed | Kind::Screw(_) | Kind::Lead => 0.0,
            Kind::ServoScrew => 1.6,
            _ => 1.0,
        },
        near: Near::Corner,
    }
}

fn supply() -> Step {
    Step {
        title: "Strips, battery and capacitor",
        words: "Tie the two terminal strips under the plate with cable ties through the slots: the one for ground on the left, the one for \
                +5 V on the right, with the capacitor behind it in the same tie. Put the battery on the plate and the strap through the slots \
                beside it, around the plate. The battery's plug stays open until all of step 3 is wired.",
        stages: vec![robot(|body| {
            named(
                body,
                &["battery", "ground strip", "supply strip", "capacitor"],
            )
        })],
        lift: |body| match body.kind {
            Kind::Battery => 1.0,
            Kind::Fitting(_) if body.name == "battery strap" => 0.0,
            _ => -0.7,
        },
        near: Near::Below,
    }
}

fn board() -> Step {
    Step {
        title: "Deck, board and wires",
        words: "Fix converter and alarm under the deck with double-sided tape and a cable tie through its window: the converter towards \
                the head. The deck goes on the standoffs, screws from above; the UNO on its bosses, its USB socket towards the tail, with \
                three screws that cut their own thread: in the hole beside the pin AREF a head has no room. Now wire everything as \
                `lizard draw --wiring` shows: leads and wires go up through the holes of plate and deck at both ends, below the deck and \
                away from the shafts. Set the converter to 5.0 V before the servos are on it.",
        stages: vec![
            robot(|body| {
                named(body, &["deck", "converter", "alarm"])
                    || (body.name.starts_with("screw standoff") && body.name.ends_with("above"))
            }),
            robot(|body| named(body, &["board", "screw board"])),
        ],
        lift: |body| match body.kind {
            Kind::Board => 1.3,
            Kind::Fitting(_) => 0.3,
            Kind::Screw(_) if body.name.contains("board") => 1.8,
            Kind::Screw(_) => 1.1,
            _ => 0.8,
        },
        near: Near::None,
    }
}

fn flash() -> Step {
    console(
        "Flash the board",
        "With USB alone: `make flash`, or the page in a browser. The LED beats slowly. Then switch the servos' supply on, and after it \
         the UNO. Send `center`: every servo turns to the middle of its travel and holds it. Leave it so for the next step.",
    )
}

fn links() -> Step {
    Step {
        title: "Horns and links",
        words: "Cut each horn to one arm, lay it into its link's pocket, and fix it with two small screws from above, 4 mm long and no \
                longer: longer ones would rub on the servo. Put the two screws with hexagon heads into the link from below, heads into \
                their pockets: nothing has to hold them later, and once the struts are on there is no way to them. The links marked 13 are for \
                A1 and A3, those marked 24 for A2 and A4. While the servos hold `center`, press each link on, its long arm outward as \
                `lizard draw --horns` shows it, at the tooth that is nearest to the neutral angle, and fix it with the horn's own screw.",
        stages: vec![bench(|body| {
            matches!(body.kind, Kind::Horn | Kind::HornScrew(_))
                || named(body, &["link", "screw tip", "screw arm"])
        })],
        lift: |body| match body.kind {
            Kind::Horn => 1.3,
            Kind::HornScrew(_) => 1.7,
            Kind::Printed => 0.8,
            _ => 0.3,
        },
        near: Near::Corner,
    }
}

fn signs() -> Step {
    console(
        "Prove the signs",
        "Nothing joins the links yet, so a servo that turns the wrong way can break nothing. Go through \"Prove the signs\" and \"Trim\" \
         of docs/quickstart.md (`lizard calibrate` leads through both): each `pose` there has to turn the named servo by 10 degrees \
         counter-clockwise, seen from above. Send `save`, then `rest`, and switch the servos' supply off.",
    )
}

fn legs() -> Step {
    Step {
        title: "Legs, on the bench",
        words: "For each leg: press a lock nut into the pocket under the crank's short arm. Put a screw from below through each end of the \
                leg's coupler, the side with the two sunk holes up; crank and follower go over them, with nuts on top. Tighten these joints \
                until they have no play and still turn by their own weight. Press a lock nut from below into the foot's tip, turn the screw \
                into it from below until 2 mm are left between head and leaf, and stick a pad on the head. Then swing crank and follower \
                aside and screw the foot's column under the coupler from above. Cranks and feet marked 13 are for the legs of A1 (front \
                left) and A3 (back right), those marked 24 for A2 (front right) and A4 (back left).",
        stages: vec![
            bench(|body| {
                named(
                    body,
                    &[
                        "leg coupler",
                        "crank",
                        "follower",
                        "screw crank joint",
                        "screw follower joint",
                        "nut crank joint",
                        "nut follower joint",
                        "nut leg anchor",
                    ],
                )
            }),
            bench(|body| matches!(body.mount, Mount::Foot(_)) && body.kind != Kind::Pad),
            bench(|body| body.kind == Kind::Pad),
        ],
        lift: |body| match body.mount {
            Mount::Foot(_) if body.name.starts_with("screw foot") => 0.6,
            Mount::Foot(_) if body.name.starts_with("leg coupler") => 0.0,
            Mount::Foot(_) => -0.6,
            _ if body.name.starts_with("nut") && !body.name.contains("anchor") => 0.5,
            _ => 0.0,
        },
        near: Near::Corner,
    }
}

fn legs_on_plate() -> Step {
    Step {
        title: "Legs on the plate",
        words: "Set both bearings of each leg on the plate and put the long screws through from above, nuts below. The crank is on the \
                pivot next to its servo.",
        stages: vec![robot(|body| body.name.contains("pivot"))],
        lift: |body| {
            if body.name.starts_with("nut") {
                -0.7
            } else {
                1.0
            }
        },
        near: Near::CornerBelow,
    }
}

fn struts(slotted: bool) -> Step {
    let (title, words) = match slotted {
        true => (
            "Struts and springs",
            "Lay each strut, channel up, under its link and with its slot over the crank's short arm. Hang one hook of the spring over the \
             slot, put the screw through hook, strut and crank and turn it into the sunk nut until the strut just moves freely. Pull the \
             spring's free hook under the link's third hole, lay the ring on it, and put the anchor's screw from above through link, ring, \
             hook and strut; the nut goes under the strut. The spring's coil lies in the channel from screw to screw.",
        ),
        false => (
            "Struts",
            "Lay each rigid strut under its link and with one hole over the crank's short arm, put the screw through strut and crank and \
             turn it into the sunk nut until the strut has no play and just moves freely. Lay the ring between strut and link, and put \
             the anchor's screw from above through link, ring and strut; the nut goes under the strut.",
        ),
    };
    Step {
        title,
        words,
        stages: vec![
            robot(|body| {
                matches!(body.mount, Mount::Strut(_)) || body.name.starts_with("screw leg anchor")
            }),
            robot(|body| named(body, &["strut ring", "screw anchor", "nut anchor"])),
        ],
        lift: |body| match body.kind {
            Kind::Screw(_) => 1.6,
            Kind::Nut => -0.4,
            Kind::Printed if body.name.starts_with("strut ring") => 0.5,
            _ => 0.3,
        },
        near: Near::Corner,
    }
}

fn sliders() -> Step {
    Step {
        title: "Sliders",
        words: "Push each rod into its sleeve: 14 is for the left side, 23 for the right. The sleeve goes on the rear arm, the rod with a \
                ring under it on the front arm; nuts on top. The rods are outside.",
        stages: vec![robot(|body| {
            matches!(body.mount, Mount::Sleeve(_) | Mount::Rod(_))
                || named(body, &["arm spacer", "nut arm"])
        })],
        lift: |body| match body.kind {
            Kind::Nut => 1.4,
            Kind::Printed if body.name.starts_with("arm") => 0.3,
            _ => 0.8,
        },
        near: Near::None,
    }
}

fn ends() -> Step {
    Step {
        title: "Head and tail",
        words: "Screw the head's plate on the coupler for A2, a long tail link on the coupler for A3, and the other one under the coupler \
                for A4. At each end the left coupler goes directly on its link, the right one on a ring. Nuts on top; a screw from below \
                joins both at the point.",
        stages: vec![
            bench(|body| {
                named(body, &["coupler", "head plate", "tail "])
                    || named(body, &["screw head plate", "screw tail "])
            }),
            robot(|body| {
                matches!(body.mount, Mount::Coupler(_)) || named(body, &["tip spacer", "nut tip"])
            }),
        ],
        lift: |body| match body.kind {
            Kind::Nut => 1.6,
            Kind::Screw(_) => 0.4,
            Kind::Printed if body.name.starts_with("tip") => 0.3,
            _ => 0.9,
        },
        near: Near::None,
    }
}

fn level() -> Step {
    console(
        "Level the feet",
        "Set the robot on a table and send `stand`. Push a sheet of paper under each foot: where it slides in freely the foot is too \
         short. Turn its screw out by a quarter turn, 0.13 mm, until all four hold their paper alike. Better with a kitchen scale: lay a \
         book as high as the scale beside it, set one foot on the scale and three on the book, and note what it shows for each foot. \
         Front left and back right together, and front right and back left together, are to show the same: turn the screws until \
         each foot is within 20 % of a quarter of the robot's weight. A quarter turn shifts about 1.6 g to or from each foot. When the \
         robot is not used, keep it on a box: a leaf that is bent for weeks stays bent.",
    )
}

fn walk() -> Step {
    console(
        "The first walk",
        "Set the robot on a box, feet in the air. Send `speed 50`, `stand`, `walk`, and watch one cycle: nothing may touch. `stop` halts at \
         once. Then on the floor. The end with the head's plate goes first. If it goes backwards or in a curve, docs/quickstart.md says \
         why. `boot walk` and `save` let it walk without a cable.",
    )
}
