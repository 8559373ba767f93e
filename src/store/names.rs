//! The names that the file format reserves, shared by the side that writes and the side that reads.

/// Root attribute: the metadata conventions that readers of netCDF look for.
pub const CONVENTIONS: &str = "Conventions";
/// The conventions followed.
pub const CONVENTIONS_FOLLOWED: &str = "CF-1.11";
/// Root attribute: marks a file as one of this program.
pub const FORMAT: &str = "capsulemap_format";
/// The layout that this version writes and reads.
pub const FORMAT_WRITTEN: &str = "1";

/// Root attribute: the model whose results they are, unless it is that of studies which name none.
pub const MODEL: &str = "model";

/// Root attribute: what else describes the whole file and is no variable over the cases, as CF has it. Attribute of a variable: what
/// varies along the paths over which it lies.
pub const COORDINATES: &str = "coordinates";
/// Root attributes that begin so hold numbers where they can.
pub const OF_PROTOCOL: &str = "protocol_";

/// Attribute: the unit of a variable.
pub const UNITS: &str = "units";
/// Attribute: what a variable is.
pub const LONG_NAME: &str = "long_name";
/// Attribute: the integers that a category takes.
pub const FLAG_VALUES: &str = "flag_values";
/// Attribute: their meanings, separated by blanks.
pub const FLAG_MEANINGS: &str = "flag_meanings";
/// Attribute: the number that stands for "missing".
pub const FILL_VALUE: &str = "_FillValue";

/// Attribute of a coordinate: that it is the scale of a dimension.
pub const CLASS: &str = "CLASS";
/// Attribute of a coordinate: its position among the dimensions, as netCDF-4 numbers them.
pub const DIMENSION_ID: &str = "_Netcdf4Dimid";
/// Attribute of a variable: the positions of its dimensions, as netCDF-4 lists them.
pub const DIMENSION_IDS: &str = "_Netcdf4Coordinates";
