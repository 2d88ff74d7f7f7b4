#include <common/scene/materials.h>

#include <algorithm>

namespace Friction
{
  template <int dim>
  Materials<dim>::Materials(const Material &everywhere)
    : all(1, everywhere)
  {}



  template <int dim>
  void
  Materials<dim>::add_region(const types::material_id id,
                             const Material          &material)
  {
    regions.push_back({id, nullptr});
    all.push_back(material);
  }



  template <int dim>
  void
  Materials<dim>::add_region(
    const std::shared_ptr<const Function<dim>> &condition,
    const Material                             &material)
  {
    regions.push_back({numbers::invalid_material_id, condition});
    all.push_back(material);
  }



  template <int dim>
  std::vector<types::material_id>
  Materials<dim>::ids() const
  {
    std::vector<types::material_id> ids;
    for (const Region &region : regions)
      if (region.condition == nullptr)
        ids.push_back(region.id);
    return ids;
  }



  template <int dim>
  bool
  Materials<dim>::uses_means() const
  {
    return std::any_of(all.begin(), all.end(), [](const Material &material) {
      return material.volumetric_strain() == VolumetricStrain::mean;
    });
  }



  template <int dim>
  unsigned int
  Materials<dim>::find_region(const types::material_id id,
                              const Point<dim>        &middle) const
  {
    for (unsigned int i = regions.size(); i > 0; --i)
      {
        const Region &region = regions[i - 1];
        if (region.condition == nullptr ? region.id == id
                                        : region.condition->value(middle) != 0.)
          return i;
      }
    return 0;
  }



  template class Materials<2>;
  template class Materials<3>;
} // namespace Friction
