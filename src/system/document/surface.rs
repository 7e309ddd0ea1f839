//! What the triangles of the geometry are: which ones (selectors), and what they do to light.

use super::coating::Specular;
use super::exact::Exact;
use super::geometry::origin;
use crate::system::units::{Angle, Direction, Position};
use serde::{Deserialize, Deserializer, de};
use std::fmt;

/// Properties of the triangles that `on` selects. A later entry overrides an earlier one, field by field, where both
/// select; `coating` and `specular` are one field with two spellings.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// Which triangles.
    pub on: Selector,
    /// What reports call these triangles; the node's name if not given.
    pub name: Option<String>,
    /// What fills the closed solid that they bound: a name in `media`, or "vacuum".
    pub medium: Option<String>,
    /// What is specular.
    pub specular: Option<Specular>,
    /// What is specular: a name in `coatings`.
    pub coating: Option<String>,
    /// How they scatter: a name in `scatter`.
    pub scatter: Option<String>,
    /// How scatter and coating share the light.
    pub order: Option<Order>,
    /// Which side this entry is about; the front is where normals point to. What no entry says of the other side: an
    /// opaque part absorbs there, a face of glass is a bare interface.
    pub side: Option<Side>,
    /// Along what the surface was ground, brushed or woven, in the world; light sees its projection on the surface. Scatter that
    /// depends on the azimuth counts it from here.
    pub lay: Option<Direction>,
    /// Whether scatter is on.
    pub scattering: Option<Scattering>,
    /// Where half of what they scatter is sent: names in `targets`.
    pub aim: Option<Vec<String>>,
    /// Which solid wins where two overlap: the higher number.
    pub priority: Option<i32>,
    /// Media in front of and behind an open sheet, which thereby is an interface.
    pub between: Option<(String, String)>,
    /// What is between this part and a glass it touches.
    pub gap: Option<Gap>,
    /// What the triangles truly are.
    pub exact: Option<Exact>,
}

impl Surface {
    /// An entry that says nothing yet about what it selects.
    pub fn new(on: Selector) -> Surface {
        Surface {
            on,
            name: None,
            medium: None,
            specular: None,
            coating: None,
            scatter: None,
            order: None,
            side: None,
            lay: None,
            scattering: None,
            aim: None,
            priority: None,
            between: None,
            gap: None,
            exact: None,
        }
    }
}

/// What triangles do to light that no entry of `surfaces` selects.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Finish {
    /// What is specular.
    pub specular: Option<Specular>,
    /// What is specular: a name in `coatings`.
    pub coating: Option<String>,
    /// How they scatter: a name in `scatter`.
    pub scatter: Option<String>,
    /// How scatter and coating share the light.
    pub order: Option<Order>,
    /// Which side this is about; the other side absorbs.
    pub side: Option<Side>,
    /// Along what the surfaces were ground, brushed or woven, in the world.
    pub lay: Option<Direction>,
    /// Whether scatter is on.
    pub scattering: Option<Scattering>,
    /// Where half of what they scatter is sent: names in `targets`.
    pub aim: Option<Vec<String>>,
}

/// How scatter and coating share the light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Order {
    /// Scatter takes its share of the incident flux, the coating acts on the rest.
    #[default]
    ScatterFirst,
    /// Scatter is scaled by the coating's reflectance or transmittance.
    Scaled,
    /// The scatter model is total: it contains the specular part.
    Total,
}

/// Sides of a surface. The front is the side that normals point to (vertices counter-clockwise).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Side {
    /// Both sides.
    #[default]
    Both,
    /// Only the side normals point to.
    Front,
    /// Only the other side.
    Back,
}

/// A switch for scatter, so that one entry can turn off what an earlier one gave.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Scattering {
    /// The surface scatters as `scatter` says.
    #[default]
    On,
    /// The surface does not scatter.
    Off,
}

/// What is between a part and a glass whose face lies on its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Gap {
    /// Nothing: optical contact.
    #[default]
    Contact,
    /// A film of what surrounds the glass: light leaves the glass, with Fresnel reflection or its coating, before it meets
    /// the part.
    Air,
}

/// A set of triangles. Globs know `*` and `?`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Selector {
    /// Triangles whose glTF material has a name that matches the glob.
    Tag(String),
    /// Nodes whose name or path (`root/child`) matches the glob.
    Node(String),
    /// Nodes whose glTF `extras` hold this value under this key.
    Extras {
        /// Key in `extras`.
        key: String,
        /// Its value.
        value: ExtrasValue,
    },
    /// Some faces of the nodes that match.
    Faces {
        /// Glob over node names and paths.
        of: String,
        /// Which faces.
        #[serde(rename = "where")]
        predicate: Predicate,
    },
    /// What any of these selects.
    Any(Vec<Selector>),
}

/// What distinguishes faces of one node.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Predicate {
    /// The normal is within an angle of the perpendicular from the axis to the face: the rim of a lens, the wall of a tube.
    Radial {
        /// Direction of the axis.
        axis: Direction,
        /// A point of the axis, m.
        #[serde(default = "origin")]
        through: Position,
        /// Greatest angle, rad; inward and outward normals both count.
        within: Angle,
    },
    /// The normal is within an angle of a direction.
    Normal {
        /// The direction.
        direction: Direction,
        /// Greatest angle, rad.
        within: Angle,
    },
    /// The centroid lies in an axis-parallel box.
    Box {
        /// Least corner, m.
        min: Position,
        /// Greatest corner, m.
        max: Position,
    },
    /// The smooth region nearest to a point.
    Nearest {
        /// The point, m.
        point: Position,
        /// Neighbours belong to one region where their normals differ by no more than this, rad.
        #[serde(default = "default_smooth")]
        smooth: Angle,
    },
    /// What all of these hold for.
    All(Vec<Predicate>),
}

/// A value in the `extras` of a glTF node.
#[derive(Debug, Clone, PartialEq)]
pub enum ExtrasValue {
    /// A string.
    Text(String),
    /// A number.
    Number(f64),
    /// A truth value.
    Flag(bool),
}

impl<'de> Deserialize<'de> for ExtrasValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Any;
        impl de::Visitor<'_> for Any {
            type Value = ExtrasValue;
            fn expecting(&self, out: &mut fmt::Formatter) -> fmt::Result {
                out.write_str("a string, a number, true or false")
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<ExtrasValue, E> {
                Ok(ExtrasValue::Text(text.to_owned()))
            }
            fn visit_f64<E: de::Error>(self, number: f64) -> Result<ExtrasValue, E> {
                Ok(ExtrasValue::Number(number))
            }
            fn visit_f32<E: de::Error>(self, number: f32) -> Result<ExtrasValue, E> {
                // ron proposes the narrowest float; its shortest decimal form is what was written.
                Ok(ExtrasValue::Number(number.to_string().parse().unwrap_or(f64::from(number))))
            }
            fn visit_u64<E: de::Error>(self, number: u64) -> Result<ExtrasValue, E> {
                Ok(ExtrasValue::Number(number as f64))
            }
            fn visit_i64<E: de::Error>(self, number: i64) -> Result<ExtrasValue, E> {
                Ok(ExtrasValue::Number(number as f64))
            }
            fn visit_bool<E: de::Error>(self, flag: bool) -> Result<ExtrasValue, E> {
                Ok(ExtrasValue::Flag(flag))
            }
        }
        deserializer.deserialize_any(Any)
    }
}

/// The largest angle between neighbours on a smooth face, rad.
pub fn default_smooth() -> Angle {
    Angle(20_f64.to_radians())
}
