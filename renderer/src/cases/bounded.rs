//! Lists of a file that cannot take more memory than they should: each has a most of elements and no room to spare
//! once it is read, so that `0,0,0,` in a file of any size is four times its size in memory and no more.

use serde::de::{DeserializeOwned, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use std::collections::BTreeMap;
use std::fmt::{Formatter, Result as Formatted};
use std::marker::PhantomData;

/// The most bytes of the elements of one list.
const MAX_LIST: usize = 1 << 19;

/// The most entries of one map.
const MAX_MAP: usize = 1 << 10;

/// For `#[serde(deserialize_with)]`: a list of at most 512 KiB.
pub(super) fn list<'de, D: Deserializer<'de>, T: DeserializeOwned>(from: D) -> Result<Vec<T>, D::Error> {
    from.deserialize_seq(List(PhantomData))
}

/// As [`list`], or `null`.
pub(super) fn optional_list<'de, D: Deserializer<'de>, T: DeserializeOwned>(
    from: D,
) -> Result<Option<Vec<T>>, D::Error> {
    from.deserialize_option(Maybe(PhantomData))
}

/// As [`list`], or the values of a map.
pub(super) fn list_or_values<'de, D: Deserializer<'de>, T: DeserializeOwned>(from: D) -> Result<Vec<T>, D::Error> {
    from.deserialize_any(List(PhantomData))
}

/// A map of at most 1024 entries.
pub(super) fn map<'de, D: Deserializer<'de>, T: DeserializeOwned>(from: D) -> Result<BTreeMap<String, T>, D::Error> {
    from.deserialize_map(Map(PhantomData))
}

/// Appends unless the list is full.
fn push<T, E: Error>(list: &mut Vec<T>, next: T) -> Result<(), E> {
    let most = MAX_LIST / size_of::<T>().max(1);
    if list.len() == most {
        return Err(E::custom(format_args!("a list of more than {most} elements")));
    }
    list.push(next);
    Ok(())
}

struct List<T>(PhantomData<T>);

impl<'de, T: DeserializeOwned> Visitor<'de> for List<T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut Formatter<'_>) -> Formatted {
        f.write_str("a list")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut from: A) -> Result<Vec<T>, A::Error> {
        let mut list = Vec::new();
        while let Some(next) = from.next_element()? {
            push(&mut list, next)?;
        }
        list.shrink_to_fit();
        Ok(list)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut from: A) -> Result<Vec<T>, A::Error> {
        // In the order of the names; the later of two equal names holds.
        let mut named = BTreeMap::new();
        while let Some((name, value)) = from.next_entry::<String, T>()? {
            named.insert(name, value);
            if named.len() > MAX_MAP {
                return Err(A::Error::custom(format_args!("more than {MAX_MAP} names")));
            }
        }
        Ok(named.into_values().collect())
    }
}

struct Maybe<T>(PhantomData<T>);

impl<'de, T: DeserializeOwned> Visitor<'de> for Maybe<T> {
    type Value = Option<Vec<T>>;

    fn expecting(&self, f: &mut Formatter<'_>) -> Formatted {
        f.write_str("a list or null")
    }

    fn visit_none<E>(self) -> Result<Self::Value, E> {
        Ok(None)
    }

    fn visit_unit<E>(self) -> Result<Self::Value, E> {
        Ok(None)
    }

    fn visit_some<D: Deserializer<'de>>(self, from: D) -> Result<Self::Value, D::Error> {
        list(from).map(Some)
    }
}

struct Map<T>(PhantomData<T>);

impl<'de, T: DeserializeOwned> Visitor<'de> for Map<T> {
    type Value = BTreeMap<String, T>;

    fn expecting(&self, f: &mut Formatter<'_>) -> Formatted {
        f.write_str("a map")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut from: A) -> Result<Self::Value, A::Error> {
        let mut map = BTreeMap::new();
        while let Some((name, value)) = from.next_entry()? {
            map.insert(name, value);
            if map.len() > MAX_MAP {
                return Err(A::Error::custom(format_args!("more than {MAX_MAP} names")));
            }
        }
        Ok(map)
    }
}
