#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the ROS 2 type hashes of a header against the IDL file that they describe.

    ros2_type_hash.py ros2.idl ros2_type.hpp ros2.md

A type hash (REP-2011, RIHS01) is the SHA-256 of a canonical JSON description of a message: names,
order and types of all members at all levels. The hashes of the sensor_msgs and diagnostic_msgs types
are ROS's own, so agreement proves that the IDL has exactly ROS's members. Every octet of the IDL is a
ROS uint8, but for those in BYTES. The document must have the definitions of all types of convexcut, as
ROS writes them and each under the line "# TYPE.msg", with the same members.
Exit status 0: every @topic type has its hash in the header, and the document agrees.
"""

import hashlib
import json
import re
import sys

# type_description_interfaces/msg/FieldType.msg
TYPE_IDS = {
    'octet': 3, 'short': 4, 'unsigned short': 5, 'long': 6, 'unsigned long': 7, 'long long': 8,
    'unsigned long long': 9, 'float': 10, 'double': 11, 'boolean': 15, 'string': 17,
}
BYTE = 16
BYTES = {('diagnostic_msgs/msg/DiagnosticStatus', 'level')}
NESTED, ARRAY_OFFSET, SEQUENCE_OFFSET = 1, 48, 144

TOKEN = re.compile(
    r'module\s+(?P<module>\w+)\s*\{|struct\s+(?P<struct>\w+)\s*\{(?P<body>[^}]*)\}\s*;|\}\s*;')
MEMBER = re.compile(r'(?P<type>[\w:<> ]+?)\s+(?P<name>\w+)(?:\[(?P<count>\d+)\])?\s*;')


def ros_name(idl_name, module):
    """sensor_msgs::msg::dds_::Imu_, or Imu_ inside that module -> sensor_msgs/msg/Imu"""
    parts = idl_name.split('::') if '::' in idl_name else module + [idl_name]
    return '/'.join([p for p in parts[:-1] if p != 'dds_'] + [parts[-1].removesuffix('_')])


def field(member, module, struct):
    type_name, capacity, offset = member['type'].strip(), 0, 0
    if member['count']:
        capacity, offset = int(member['count']), ARRAY_OFFSET
    sequence = re.fullmatch(r'sequence<\s*([\w: ]+?)\s*>', type_name)
    if sequence:
        type_name, offset = sequence[1], SEQUENCE_OFFSET
    nested = '' if type_name in TYPE_IDS else ros_name(type_name, module)
    is_byte = (ros_name(struct, module), member['name']) in BYTES
    type_id = BYTE if is_byte else TYPE_IDS.get(type_name, NESTED)
    return {'name': member['name'],
            'type': {'type_id': type_id + offset, 'capacity': capacity,
                     'string_capacity': 0, 'nested_type_name': nested}}


def parse(idl):
    idl = re.sub(r'//.*', '', idl)
    module, types, topics = [], {}, []
    for token in TOKEN.finditer(idl):
        if token['module']:
            module.append(token['module'])
        elif token['struct']:
            name = ros_name(token['struct'], module)
            types[name] = {'type_name': name,
                           'fields': [field(m, module, token['struct']) for m in MEMBER.finditer(token['body'])]}
            if idl[:token.start()].rstrip().endswith('@topic'):
                topics.append(name)
        else:
            module.pop()
    return types, topics


def type_hash(name, types):
    references, queue = set(), [name]
    while queue:
        for member in types[queue.pop()]['fields']:
            nested = member['type']['nested_type_name']
            if nested and nested not in references:
                references.add(nested)
                queue.append(nested)
    description = {'type_description': types[name],
                   'referenced_type_descriptions': [types[r] for r in sorted(references)]}
    return 'RIHS01_' + hashlib.sha256(json.dumps(description).encode()).hexdigest()


ROS_TYPE_IDS = {'uint8': 3, 'uint16': 5, 'int32': 6, 'uint32': 7, 'int64': 8, 'uint64': 9,
                'float32': 10, 'float64': 11, 'bool': 15, 'string': 17}
PACKAGE = 'convexcut/msg/'


def documented_members(document, name):
    """[(type id, nested type, name)] of the lines below "# NAME.msg"; constants have a '='."""
    block = re.search(rf'^    # {name}\.msg.*\n((?:    .*\n)*?)(?=    # \w+\.msg|\n|\Z)', document,
                      re.MULTILINE)
    members = []
    for kind, sequence, member in re.findall(r'^    ([\w/]+)(\[\])? +(\w+) *(?:#.*)?$',
                                             block[1] if block else '', re.MULTILINE):
        nested = '' if kind in ROS_TYPE_IDS else kind if '/' in kind else PACKAGE + kind
        nested = nested.replace('builtin_interfaces/Time', 'builtin_interfaces/msg/Time')
        members.append((ROS_TYPE_IDS.get(kind, NESTED) + (SEQUENCE_OFFSET if sequence else 0),
                        nested, member))
    return members


def main(idl_path, header_path, document_path):
    with open(idl_path, encoding='utf-8') as file:
        types, topics = parse(file.read())
    with open(header_path, encoding='utf-8') as file:
        header = file.read()
    missing = 0
    for name in topics:
        value = type_hash(name, types)
        found = value in header
        missing += not found
        print(f'{name} {value} {"ok" if found else "NOT IN " + header_path}')
    with open(document_path, encoding='utf-8') as file:
        document = file.read()
    wrong = 0
    for name in [n for n in types if n.startswith(PACKAGE)]:
        expected = [(m['type']['type_id'], m['type']['nested_type_name'], m['name'])
                    for m in types[name]['fields']]
        documented = documented_members(document, name.removeprefix(PACKAGE))
        if documented != expected:
            wrong += 1
            print(f'{document_path}: {name} is {documented}, expected {expected}')
    return 1 if missing or not topics or wrong else 0


if __name__ == '__main__':
    sys.exit(main(*sys.argv[1:]))
