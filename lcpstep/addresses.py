"""Numba's side of `compiled.by_address`: how large named tuples go from kernel to kernel by one pointer.

Numba passes a tuple by value: twenty arrays are 140 numbers, copied at every call that is not inlined, and a
type whose name alone takes pages. A class marked with `by_address` is a pointer instead, to a record that is
filled in where Python calls the kernel and does not change until that call returns. A field is read as from
any named tuple. This module is imported when the first kernel is compiled or loaded.

Source: numba's documentation, "Low-level extension API".
"""

from __future__ import annotations

import hashlib
from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.datamodel import models
from numba.core.datamodel.registry import register_default
from numba.core.typing.templates import AttributeTemplate
from numba.core.typing.typeof import typeof_impl
from numba.extending import NativeValue, infer_getattr, lower_getattr_generic, unbox

from lcpstep.compiled import ByAddress

DIGITS = 12  # of a fingerprint in a name


class Address(types.Type):
    """Numba's type of a tuple that is passed by address; `record` is the tuple's own."""

    def __init__(self, record: Any) -> None:
        self.record = record
        cls = record.instance_class
        text = f"{cls.__module__} {record.fields} {record.name}"  # its own name tells types, but not of which field
        super().__init__(f"{cls.__name__}_{hashlib.sha256(text.encode()).hexdigest()[:DIGITS]}")


@register_default(Address)
class AddressModel(models.PrimitiveModel):
    """In machine code: a pointer."""

    def __init__(self, manager: Any, kind: Address) -> None:
        super().__init__(manager, kind, manager.lookup(kind.record).get_data_type().as_pointer())


@typeof_impl.register(ByAddress)
def typeof_address(value: Any, context: Any) -> Address | None:
    """Type of a marked tuple, by the types of its fields."""
    fields = tuple(typeof_impl(field, context) for field in value)
    return None if None in fields else Address(types.containers.BaseTuple.from_types(fields, type(value)))


@unbox(Address)
def unbox_address(kind: Address, tuple_: Any, c: Any) -> NativeValue:
    """Fill in the record from the Python tuple, on the stack of the function that Python called."""
    fields = c.unbox(kind.record, tuple_)
    place = cgutils.alloca_once(c.builder, c.context.data_model_manager[kind.record].get_data_type())
    c.context.pack_value(c.builder, kind.record, fields.value, place)
    # The optimiser must not see through this, since `read_field` says that nothing ever writes to the record.
    same = ir.InlineAsm(ir.FunctionType(place.type, [place.type]), "", "=r,0,~{memory}", side_effect=True)
    return NativeValue(c.builder.call(same, [place]), fields.is_error, fields.cleanup)


@infer_getattr
class Fields(AttributeTemplate):
    """Types of the fields."""

    key = Address

    def generic_resolve(self, kind: Address, name: str) -> Any:
        """Type of one field; None where there is none of that name."""
        fields = kind.record.fields
        return kind.record.types[fields.index(name)] if name in fields else None


@lower_getattr_generic(Address)
def read_field(context: Any, builder: Any, kind: Address, place: Any, name: str) -> Any:
    """Read a field; marked as constant, so that loops need not read it again."""
    index = kind.record.fields.index(name)
    before = len(builder.block.instructions)
    field = cgutils.gep_inbounds(builder, place, 0, index)
    value = context.unpack_value(builder, kind.record.types[index], field)
    for instruction in builder.block.instructions[before:]:
        if isinstance(instruction, ir.LoadInstr):
            instruction.set_metadata("invariant.load", builder.module.add_metadata([]))
    return value
