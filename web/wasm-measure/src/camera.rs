//! The film that the page takes, and the measurement of the gaits in it.

use lizard_film::{Film, Picture, Setup, Tag, sheet};
use lizard_measure::{Gaits, NamedFilm, Report, board_height};
use lizard_robot::Robot;
use serde::{Deserialize, Serialize};
use tsify::Tsify;

/// A refusal: the reason as a sentence.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Tsify)]
pub struct Refused {
    /// The reason.
    pub refused: String,
}

impl Refused {
    pub(crate) fn of(reason: impl ToString) -> Self {
        Self {
            refused: reason.to_string(),
        }
    }
}

/// A tag in a picture.
#[derive(Debug, Clone, PartialEq, Serialize, Tsify)]
pub struct TagEntry {
    /// The tag's id on the sheet.
    pub id: usize,
    /// The tag's corners, px: those that are top left, top right, bottom right and bottom left on the printed sheet.
    #[tsify(type = "[Pixel, Pixel, Pixel, Pixel]")]
    pub corners: [[f64; 2]; 4],
}

/// A request to measure gaits in the film.
#[derive(Debug, Clone, PartialEq, Deserialize, Tsify)]
pub struct MeasureRequest {
    /// The text of the robot.toml.
    pub toml: String,
    /// The pace, percent of a gait's own pace.
    pub speed: u8,
    /// Height of the deck's tag above the floor, mm; `None` if the tag lies on the robot's board.
    pub height: Option<f64>,
    /// Measured length, mm, of the line on the sheet that should be 100 mm long.
    pub ruler: f64,
    /// The walks to measure. If empty, the film is split where the robot rests, and each walk is assigned the gait
    /// that it matches.
    pub walks: Vec<RequestedWalk>,
}

/// A gait that the robot walked in the film.
#[derive(Debug, Clone, PartialEq, Deserialize, Tsify)]
pub struct RequestedWalk {
    /// The gait's name.
    pub gait: String,
    /// Start and end of the walk on the film's clock, s; `None` for the whole film.
    pub during: Option<[f64; 2]>,
}

/// The measured displacements of gaits.
#[derive(Debug, Clone, PartialEq, Serialize, Tsify)]
pub struct Results {
    /// The gaits as `lizard measure --json` writes them; walks of the same gait count together.
    #[tsify(type = "Report[]")]
    pub gaits: serde_json::Value,
    /// For each walk that cannot be measured, a sentence with its gait and the reason.
    pub problems: Vec<String>,
}

/// A film that is being taken.
#[derive(Debug, Default)]
pub struct Camera {
    film: Film,
    /// The analysis of the film, and the setup that it is valid for; `None` after a new picture.
    cached_analysis: Option<(Setup, NamedFilm)>,
}

impl Camera {
    /// Finds the tags in a picture without adding it to the film.
    pub fn find_tags(&mut self, picture: &Picture) -> Vec<TagEntry> {
        let tags = self.film.find_tags(picture).into_iter();
        tags.map(|Tag { id, corners }| TagEntry { id, corners })
            .collect()
    }

    /// Adds the next picture, taken at `seconds` on the film's clock, and returns its tags.
    ///
    /// # Errors
    /// Fails if the picture does not belong to the film, or shows a tag twice.
    pub fn add_picture(
        &mut self,
        picture: &Picture,
        seconds: f64,
    ) -> Result<Vec<TagEntry>, Refused> {
        self.cached_analysis = None;
        let tags = self.film.add(seconds, picture).map_err(Refused::of)?;
        let entry_of = |(id, corners): (usize, &Option<_>)| {
            Some(TagEntry {
                id,
                corners: (*corners)?,
            })
        };
        Ok(tags.iter().enumerate().filter_map(entry_of).collect())
    }

    /// Measures gaits in the film.
    ///
    /// # Errors
    /// Fails if the robot.toml is invalid, the robot has no such gait, the film does not show what is needed, or a
    /// walk without a given gait does not clearly resemble one.
    pub fn measure(&mut self, request: &MeasureRequest) -> Result<Results, Refused> {
        let robot = Robot::parse(&request.toml).map_err(Refused::of)?;
        let find_gait = |walk: &RequestedWalk| {
            let gait = robot.gait(&walk.gait).filter(|gait| gait.has_movement());
            gait.ok_or_else(|| Refused::of(format!("no gait `{}` moves this robot", walk.gait)))
        };
        let named_gaits: Vec<_> = request
            .walks
            .iter()
            .map(find_gait)
            .collect::<Result<_, _>>()?;
        let setup = Setup {
            print_scale: request.ruler / sheet::RULER_LENGTH,
            deck_height: request.height.unwrap_or_else(|| board_height(&robot)),
        };
        let gaits = Gaits::new(&robot, &named_gaits, f64::from(request.speed) / 100.0);
        let film = match self.cached_analysis.take() {
            Some((cached_setup, film)) if cached_setup == setup => film,
            _ => NamedFilm {
                name: "the film".to_owned(),
                analysis: self.film.analyse(setup).map_err(Refused::of)?,
            },
        };
        let (_, film) = self.cached_analysis.insert((setup, film));
        let films = std::slice::from_ref(&*film);
        let mut problems = Vec::new();
        let walks = match request.walks.is_empty() {
            true => gaits.measure_walks(films).map_err(Refused::of)?,
            false => {
                let measured_walks = request.walks.iter().enumerate().filter_map(|(i, walk)| {
                    let measured_walk = gaits.measure_walk(i, &films[0], walk.during);
                    let measured_walk = measured_walk
                        .map_err(|reason| problems.push(format!("{}: {reason}", walk.gait)));
                    measured_walk.ok()
                });
                measured_walks.collect()
            }
        };
        let report = Report::new(&robot, request.speed, setup, films, &gaits, &walks);
        let report = report.with_ranges(&robot).with_mujoco(&request.toml);
        Ok(Results {
            gaits: serde_json::to_value(&report.gaits).map_err(Refused::of)?,
            problems,
        })
    }
}
