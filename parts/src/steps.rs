//! The order in which the robot is put together.
//!
//! A step is one picture of the guide. Within it hands still do one thing after
//! another, some of it on the bench before it is set on the robot: these are its
//! stages, and a screw can be reached or not depending on the stage. `reach.rs` looks.

use crate::body::{Body, Kind, Mount};

/// One step of the guide.
pub struct Step {
    /// Its headline.
    pub title: &'static str,
    /// What to do.
    pub words: String,
    /// What is added, in this order.
    pub stages: Vec<Stage>,
    /// How far a body is lifted in the exploded picture, as a share.
    pub lift: fn(&Body) -> f64,
}

/// What is added at once.
pub struct Stage {
    /// Where its screws are turned.
    pub at: Where,
    /// Whether a body is added in it, if no stage before added it.
    pub adds: fn(&Body) -> bool,
}

/// Where the screws of a stage are turned.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Where {
    /// On the robot: everything that was added before is around.
    Robot,
    /// On the bench: around is only what this step added before and what belongs to
    /// the same servo.
    Bench,
}

impl Step {
    /// Whether a body is added in it.
    pub fn adds(&self, body: &Body) -> bool {
        self.stages.iter().any(|stage| (stage.adds)(body))
    }
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

/// The steps of a robot with such struts.
pub fn steps(slotted: bool) -> Vec<Step> {
    vec![
        chassis(),
        legs(),
        legs_on_plate(),
        struts(slotted),
        links(slotted),
        sliders(),
        ends(),
        deck(),
    ]
}

fn chassis() -> Step {
    Step {
        title: "Servos and standoffs",
        words: "Push each servo from above into its opening, its shaft towards the end of the robot, and fix it with its two \
                self-tapping screws. Screw the four standoffs on from below. Leave the horns off."
            .to_owned(),
        stages: vec![
            robot(|body| {
                body.name == "plate"
                    || matches!(
                        body.kind,
                        Kind::Servo | Kind::ServoScrew | Kind::Standoff(_)
                    )
                    || (body.name.starts_with("screw standoff") && body.name.ends_with("below"))
            })
        ],
        lift: |body| match body.kind {
            Kind::Printed | Kind::Screw(_) => 0.0,
            Kind::ServoScrew => 1.6,
            _ => 1.0,
        },
    }
}

fn legs() -> Step {
    Step {
        title: "Legs, on the bench",
        words: "For each leg: press a lock nut into the pocket under the crank's short arm. Put a screw from below through each end \
                of the leg's coupler; crank and follower go over them, with nuts on top. Tighten these joints until they have no play \
                and still turn by their own weight: the foot covers a head later. Then swing crank and follower aside and \
                screw the foot under the coupler, heads sunk into the coupler, nuts under the leaf. Mind left and right: cranks LF and RH are alike, and RF and LH."
            .to_owned(),
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
            bench(|body| matches!(body.mount, Mount::Foot(_))),
        ],
        lift: |body| match body.mount {
            Mount::Foot(_) => -0.5,
            _ if body.name.starts_with("nut") && !body.name.contains("anchor") => 0.5,
            _ => 0.0,
        },
    }
}

fn legs_on_plate() -> Step {
    Step {
        title: "Legs on the plate",
        words: "Set both bearings of each leg on the plate and put the long screws through from above, nuts below. The crank is on \
                the pivot next to its servo."
            .to_owned(),
        stages: vec![robot(|body| body.name.contains("pivot"))],
        lift: |body| {
            if body.name.starts_with("nut") {
                -0.7
            } else {
                1.0
            }
        },
    }
}

fn struts(slotted: bool) -> Step {
    let (title, words) = match slotted {
        true => (
            "Struts and springs",
            "Lay each strut, recess up, with its slot over the crank's short arm. Hang one hook of the spring over the slot, put the \
             screw through hook, strut and crank and turn it into the sunk nut until the strut just moves freely.",
        ),
        false => (
            "Struts",
            "Lay each rigid strut with one hole over the crank's short arm, put the screw through strut and crank and turn it into \
             the sunk nut until the strut has no play and just moves freely.",
        ),
    };
    Step {
        title,
        words: words.to_owned(),
        stages: vec![robot(|body| {
            matches!(body.mount, Mount::Strut(_)) || body.name.starts_with("screw leg anchor")
        })],
        lift: |body| {
            if body.name.starts_with("screw") {
                1.4
            } else {
                0.7
            }
        },
    }
}

fn links(slotted: bool) -> Step {
    let anchor = match slotted {
        true => {
            "Pull the spring's free hook under the link's third hole, lay the ring on it, and put the anchor's \
             screw from above through link, ring, hook and strut; the nut goes under the strut."
        }
        false => {
            "Lay the ring between strut and link, and put the anchor's screw from above through link, ring and strut; the nut goes \
             under the strut."
        }
    };
    Step {
        title: "Links and horns",
        words: format!(
            "Cut each horn to one arm and lay it into its link's pocket, fix it with two small screws from above. Put the two screws with hexagon \
             heads into the link from below, heads into their pockets: nothing has to hold them later, and once the link is on \
             there is no way to them. Run `center` on the robot so that all \
             servos stand in their middle, then press each link on at its neutral angle (`lizard draw --horns` shows it) and \
             fix it with the horn's own screw. {anchor}"
        ),
        stages: vec![
            bench(|body| {
                matches!(body.kind, Kind::Horn) || named(body, &["link", "screw tip", "screw arm"])
            }),
            robot(|body| named(body, &["strut spacer", "screw anchor", "nut anchor"])),
        ],
        lift: |body| match body.kind {
            Kind::Horn => 1.3,
            Kind::Printed if body.name.starts_with("link") => 0.8,
            Kind::Screw(_) if body.name.starts_with("screw anchor") => 1.6,
            Kind::Nut => 0.0,
            Kind::Printed => 0.4,
            _ => 0.3,
        },
    }
}

fn sliders() -> Step {
    Step {
        title: "Sliders",
        words: "Push each rod into its sleeve. The sleeve goes on the rear arm, the rod with a ring under it on the front arm; nuts on top. \
                The rods are outside."
            .to_owned(),
        stages: vec![robot(|body| {
            matches!(body.mount, Mount::Sleeve(_) | Mount::Rod(_))
                || named(body, &["arm spacer", "nut arm"])
        })],
        lift: |body| match body.kind {
            Kind::Nut => 1.4,
            Kind::Printed if body.name.starts_with("arm") => 0.3,
            _ => 0.8,
        },
    }
}

fn ends() -> Step {
    Step {
        title: "Head and tail",
        words: "At each end the left coupler goes directly on its link, the right one on a ring. Nuts on top; a screw from below joins \
                both at the point."
            .to_owned(),
        stages: vec![robot(|body| {
            matches!(body.mount, Mount::Coupler(_)) || named(body, &["tip spacer", "nut tip"])
        })],
        lift: |body| match body.kind {
            Kind::Nut => 1.6,
            Kind::Screw(_) => 0.4,
            Kind::Printed if body.name.starts_with("tip") => 0.3,
            _ => 0.9,
        },
    }
}

fn deck() -> Step {
    Step {
        title: "Battery, deck and board",
        words: "Strap the battery to the plate through its window. The deck goes on the standoffs, screws from above; the UNO on its \
                bosses, USB to the tail, with three screws that cut their own thread: in the hole beside the pin AREF a head has no room. Wire it as `lizard draw --wiring` shows, and \
                keep the wires clear of the links."
            .to_owned(),
        stages: vec![
            robot(|body| {
                named(body, &["battery", "deck"])
                    || (body.name.starts_with("screw standoff") && body.name.ends_with("above"))
            }),
            robot(|body| named(body, &["board", "screw board"])),
        ],
        lift: |body| match body.kind {
            Kind::Battery => 0.0,
            Kind::Board => 1.3,
            Kind::Screw(_) if body.name.contains("board") => 1.8,
            Kind::Screw(_) => 1.1,
            _ => 0.8,
        },
    }
}
