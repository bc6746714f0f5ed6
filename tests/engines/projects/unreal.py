# Runs the script that the command names with a module `unreal` that accepts every call, and prints the panorama that the
# script imports and the properties that it sets, a line each.
import os
import runpy
import sys
import types
from unittest import mock


class Component(mock.MagicMock):
    def set_editor_property(self, name, value):
        print('set', name, value)


class Tools(mock.MagicMock):
    def import_asset_tasks(self, tasks):
        for task in tasks:
            print('import', task.destination_path, os.path.getsize(task.filename))


unreal = mock.MagicMock()
unreal.SkyLightSourceType.SLS_SPECIFIED_CUBEMAP = 'SLS_SPECIFIED_CUBEMAP'
unreal.ComponentMobility.MOVABLE = 'MOVABLE'
unreal.AssetImportTask = types.SimpleNamespace
unreal.AssetToolsHelpers.get_asset_tools.return_value = Tools()
unreal.get_editor_subsystem.return_value.spawn_actor_from_class.return_value.get_component_by_class.return_value = Component()
unreal.MaterialEditingLibrary.create_material_expression.side_effect = lambda *_: Component()
unreal.load_asset.side_effect = lambda path: path
sys.modules['unreal'] = unreal
runpy.run_path(sys.argv[1])
